//! Broken scenarios: each must be refused with its place, the offending text and a way out.

const HEAD: &str = "name = \"t\"\nseed = 1\nduration_s = 10.0\n";
const VEHICLES: &str = "[[vehicle]]\nname = \"a\"\nurdf = \"a.urdf\"\n[[vehicle]]\nname = \"b\"\nurdf = \"b.urdf\"\n";

/// What is said about `HEAD`, `top`, the two vehicles and `rest`; the first line of `top` is 4.
fn complaints(top: &str, rest: &str) -> String {
    let text = format!("{HEAD}{top}{VEHICLES}{rest}");
    match scenario::parse(&text, "s.toml", &[]) {
        Ok(_) => panic!("should be refused:\n{text}"),
        Err(errors) => errors.to_string(),
    }
}

/// Every fragment is said.
fn says(top: &str, rest: &str, fragments: &[&str]) {
    let said = complaints(top, rest);
    for fragment in fragments {
        assert!(said.contains(fragment), "for\n{top}{rest}\nexpected: {fragment}\nsaid:\n{said}");
    }
}

#[test]
fn unknown_and_misplaced_keys() {
    for (top, rest, fragments) in [
        ("sede = 2\n", "", ["s.toml:4:1:", "unknown key `sede`", "description"].as_slice()),
        ("step_s = 1e-3\n", "", &["s.toml:4:1:", "unknown key `step_s`", "it belongs into [integrator]"]),
        ("[integrator]\nstep = 1e-3\n", "", &["s.toml:5:1:", "`integrator.step`: the unit is missing", "`step_s`"]),
        ("[integrator]\nstep_ms = 1.0\n", "", &["s.toml:5:1:", "the unit is another here", "`step_s`"]),
        (
            "",
            "pose = { positon_m = [0, 0, 0] }\n",
            &["s.toml:10:10:", "`vehicle.b.pose.positon_m`; did you mean `position_m`?"],
        ),
        (
            "",
            "twist = { angular_rad_per_s = [0, 0, 0] }\n",
            &["the unit is another here; did you mean `angular_deg_per_s`?"],
        ),
        ("", "joints = { elbow = { position = 1.0 } }\n", &["`position_deg` or `position_m` or `position_rad`"]),
        (
            "[enviroment]\nkind = \"orbit\"\n",
            "",
            &["s.toml:4:2:", "unknown key `enviroment`; did you mean `environment`?"],
        ),
        ("", "[output]\nseed = 3\n", &["s.toml:11:1:", "belongs to the top of the file"]),
        ("", "[strategy]\nkind = \"none\"\nfile = \"x\"\n", &["s.toml:12:1:", "unknown key `strategy.file`"]),
    ] {
        says(top, rest, fragments);
    }
}

#[test]
fn unknown_kinds_and_names() {
    for (top, rest, fragments) in [
        (
            "[integrator]\nkind = \"implicit-eular\"\n",
            "",
            ["s.toml:5:8:", "no kind \"implicit-eular\"; did you mean \"implicit-euler\"?"].as_slice(),
        ),
        ("[environment]\nkind = \"orbits\"\n", "", &["s.toml:5:8:", "no kind \"orbits\"; did you mean \"orbit\"?"]),
        (
            "[environment]\n",
            "",
            &["s.toml:4:1:", "`environment` lacks `kind`: one of deep-space, orbit, lab, air-bearing"],
        ),
        ("", "base = \"floating\"\n", &["s.toml:10:8:", "no base \"floating\"; valid here: free, fixed"]),
        ("", "base = { free = [\"x\", \"jaw\"] }\n", &["s.toml:10:23:", "\"jaw\"; did you mean \"yaw\"?"]),
        (
            "",
            "[[contact]]\nbetween = [\"a/x\", \"c/y\"]\n",
            &["s.toml:11:19:", "`contact[0].between[1]`: no vehicle \"c\""],
        ),
        ("", "[[contact]]\nbetween = [\"a/x\", \"b\"]\n", &["must be written as vehicle/name"]),
        (
            "",
            "[[contact]]\nbetween = [\"a/*\", \"b/*\"]\nfriction = { law = \"brisle\", mu = 0.1 }\n",
            &["s.toml:12:20:", "did you mean \"bristle\"?"],
        ),
        (
            "",
            "[strategy]\nkind = \"schedule\"\ncommands = [{ actuator = \"jet\", points = [[0, 1]] }]\n",
            &["s.toml:12:26:", "no actuator \"jet\""],
        ),
        (
            "",
            "[[effect]]\nname = \"slosh\"\nplace = \"bodi:a/tank\"\n",
            &["no kind of place \"bodi\"; did you mean \"body\"?"],
        ),
        ("", "[[effect]]\nname = \"slosh\"\nplace = \"body:aa/tank\"\n", &["s.toml:12:9:", "no vehicle \"aa\""]),
    ] {
        says(top, rest, fragments);
    }
}

#[test]
fn wrong_types_and_ranges() {
    for (top, rest, fragments) in [
        (
            "description = 3\n",
            "",
            ["s.toml:4:15:", "`description` must be a text in quotes, not the whole number 3"].as_slice(),
        ),
        ("[integrator]\nstep_s = \"1 ms\"\n", "", &["s.toml:5:10:", "must be a number, not the text \"1 ms\""]),
        ("[integrator]\nstep_s = 0.0\n", "", &["s.toml:5:10:", "`integrator.step_s` = 0.0 must be greater than 0"]),
        ("[integrator]\nstep_s = nan\n", "", &["s.toml:5:10:", "not a number"]),
        ("[output]\nlog_rate_hz = inf\n", "", &["s.toml:5:15:", "must be finite"]),
        ("", "pose = { position_m = [0, 0] }\n", &["s.toml:10:23:", "must have 3 elements"]),
        (
            "",
            "pose = { position_m = [0, 0, true] }\n",
            &["s.toml:10:30:", "`vehicle.b.pose.position_m[2]` must be a number, not true"],
        ),
        ("", "pose = [0, 0, 0]\n", &["s.toml:10:8:", "must be a table, not a list of 3"]),
        ("", "base = 3\n", &["must be a text in quotes or a table, not the whole number 3"]),
        ("", "pose = { quaternion_wxyz = [0, 0, 0, 0] }\n", &["must be a unit quaternion", "norm is 0.0000"]),
        (
            "",
            "[[contact]]\nbetween = [\"a/*\", \"b/*\"]\nfriction = { law = \"bristle\", mu = -0.1, stiffness_n_per_m = 1e5 }\n",
            &["s.toml:12:36:", "`contact[0].friction.mu` = -0.1 must be at least 0"],
        ),
        (
            "",
            "[[actuator]]\nname = \"jet\"\nkind = \"thruster\"\nlink = \"a/base\"\nposition_m = [0, 0, 0]\ndirection = [0, 0, 0]\nmax_force_n = 1.0\n",
            &["s.toml:15:13:", "must not be the zero vector"],
        ),
        (
            "",
            "[[actuator]]\nname = \"w\"\nkind = \"reaction-wheel\"\nlink = \"a/base\"\naxis = [0, 0, 1]\ninertia_kg_m2 = -1\ntorque_limit_n_m = 1\nspeed_limit_rad_per_s = 600\n",
            &["s.toml:15:17:", "`actuator.w.inertia_kg_m2` = -1 must be greater than 0"],
        ),
        (
            "",
            "[[shape]]\nname = \"s\"\nkind = \"box\"\nsize_m = [1, 0, 1]\n",
            &["s.toml:13:14:", "`shape.s.size_m[1]` = 0 must be greater than 0"],
        ),
        ("", "urdf = 1979-05-27\n", &["s.toml:10:1:", "duplicate key"]),
        ("[integrator]\nstep_s = 0.9\n[campaign]\nruns = 0\n", "", &["s.toml:7:8:", "must be at least 1"]),
    ] {
        says(top, rest, fragments);
    }
}

#[test]
fn keys_that_do_not_go_together() {
    let pair = "[[contact]]\nbetween = [\"a/*\", \"b/*\"]\n";
    for (rest, fragments) in [
        ("pose = { rpy_deg = [0, 0, 0], quaternion_wxyz = [1, 0, 0, 0] }\n".to_owned(), ["s.toml:10:31:", "`rpy_deg` and `quaternion_wxyz` exclude each other"].as_slice()),
        ("joints = { j = { position_deg = 1, position_m = 1 } }\n".to_owned(), &["`position_deg` and `position_m` exclude each other"]),
        (format!("{pair}friction = {{ law = \"bristle\", mu = 0.3, mu_static = 0.2, stribeck_velocity_m_per_s = 0.01, stiffness_n_per_m = 1e5 }}\n"), &["s.toml:12:53:", "`mu` = 0.3 must not exceed `mu_static` = 0.2"]),
        (format!("{pair}friction = {{ law = \"bristle\", mu = 0.3, mu_static = 0.4, stiffness_n_per_m = 1e5 }}\n"), &["`mu_static` does nothing without `stribeck_velocity_m_per_s`"]),
        (format!("{pair}friction = {{ law = \"bristle\", mu = 0.3 }}\n"), &["`contact[0].friction` lacks `stiffness_n_per_m`: Stiffness of the bristle, N/m"]),
        ("[[expect]]\nmetric = \"captured\"\n".to_owned(), &["s.toml:10:1:", "needs `equals` or `at_most` or `at_least` or `between`"]),
        ("[[expect]]\nmetric = \"slip\"\nbetween = [2, 1]\n".to_owned(), &["s.toml:12:11:", "must ascend"]),
        ("[campaign]\nruns = 3\n[[campaign.disperse]]\npath = \"vehicle.c.pose.position_m[0]\"\nnormal = { sigma = 0.1 }\n".to_owned(), &["s.toml:13:8:", "at `vehicle`, none is named \"c\""]),
        ("[campaign]\nruns = 3\n[[campaign.disperse]]\npath = \"vehicle.a.urdf\"\nnormal = { sigma = 0.1 }\n".to_owned(), &["only numbers can be dispersed"]),
        ("[campaign]\nruns = 3\n[[campaign.disperse]]\npath = \"duration_s\"\nuniform = { low = 2, high = 1 }\n".to_owned(), &["s.toml:14:29:", "`low` = 2 must not exceed `high` = 1"]),
        ("[[vehicle]]\nname = \"a\"\nurdf = \"c.urdf\"\n".to_owned(), &["s.toml:11:8:", "the name \"a\" is taken at s.toml:5:8"]),
        ("[[vehicle]]\nname = \"\"\nurdf = \"c.urdf\"\n".to_owned(), &["s.toml:11:8:", "must not be empty"]),
        ("[[vehicle]]\nname = \"a/b\"\nurdf = \"c.urdf\"\n".to_owned(), &["must be letters, digits"]),
        ("[[vehicle]]\nname = \"world\"\nurdf = \"c.urdf\"\n".to_owned(), &["is the name of the surroundings"]),
        ("[[actuator]]\nname = \"d\"\nkind = \"joint-drive\"\njoint = \"a/j\"\n".to_owned(), &["needs `stiffness_n_m_per_rad` or `stiffness_n_per_m`"]),
        ("[integrator]\nstep_s = 1.0\n[strategy]\nkind = \"replay\"\n".to_owned(), &["s.toml:12:1:", "`strategy` lacks `file`"]),
    ] {
        says("", &rest, fragments);
    }
}

#[test]
fn broken_syntax_has_a_place_and_says_what_was_expected() {
    for (text, fragments) in [
        ("name = \"t\nseed = 1\n", ["s.toml:1:", "not valid TOML", "expected"].as_slice()),
        ("name = \"t\"\nseed 1\n", &["s.toml:2:", "expected"]),
        ("name = \"t\"\nseed = \n", &["s.toml:2:"]),
        ("[vehicle\nname = 1\n", &["s.toml:1:"]),
        ("seed = 99999999999999999999\n", &["s.toml:1:8:", "does not fit into 64 bits"]),
        ("a = [1, 2\nb = 3\n", &["s.toml:"]),
        ("seed = 1\nseed = 2\n", &["s.toml:2:1:", "duplicate key"]),
    ] {
        let said = scenario::parse(text, "s.toml", &[]).map(|_| ()).expect_err(text).to_string();
        for fragment in fragments {
            assert!(said.contains(fragment), "for\n{text}\nexpected: {fragment}\nsaid:\n{said}");
        }
    }
}

#[test]
fn every_fault_is_told_at_once_in_the_order_of_the_file() {
    let text = "nam = \"t\"\nduration = 3\n[integrator]\nkind = \"rk5\"\nstep_s = -1\n[[vehicle]]\nname = \"a\"\n";
    let errors = scenario::parse(text, "s.toml", &["output.log_rate=3".to_owned()]).expect_err("many faults").errors;
    let said: Vec<String> = errors.iter().map(ToString::to_string).collect();
    assert_eq!(said.len(), 7, "{said:#?}");
    for (error, fragment) in said.iter().zip([
        "unknown key `nam`; did you mean `name`?",
        "s.toml:1:1: the scenario lacks `seed`",
        "unknown key `duration`",
        "\"rk5\"",
        "step_s",
        "`vehicle.a` lacks `urdf`",
        "--set 'output.log_rate=3': unknown key `output.log_rate`: the unit is missing",
    ]) {
        assert!(error.contains(fragment), "{error} should contain {fragment}");
    }
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let said = scenario::load(std::path::Path::new("no/such.toml"), &[]).expect_err("missing").to_string();
    assert!(said.starts_with("no/such.toml: cannot read the scenario"), "{said}");
}

#[test]
fn a_file_of_rubbish_is_refused_in_no_time() {
    let start = std::time::Instant::now();
    for text in
        ["a=1\n".repeat(100_000), "[[vehicle]]\n".repeat(100_000), "a.".repeat(100_000), "x = [".repeat(100_000)]
    {
        let errors = scenario::parse(&text, "s.toml", &[]).expect_err("rubbish").errors;
        assert!(errors.len() <= 1001, "{} errors", errors.len());
    }
    assert!(start.elapsed().as_secs() < 20, "took {:?}", start.elapsed());
}
