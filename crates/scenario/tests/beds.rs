//! `[[shape]]` entries whose contact is spread over a face.

/// A block of 1 kg on the floor, which meets it with a bed alone: the rule for the bed comes after that for the link.
fn block_with(bed: &str) -> String {
    format!(
        "name = \"beds\"\nseed = 1\nduration_s = 1.0\n\
         [environment]\nkind = \"lab\"\ngravity_m_per_s2 = [0.0, 0.0, -10.0]\n\
         [[vehicle]]\nname = \"block\"\nurdf = \"robots/bench/peer-block.urdf\"\npose = {{ position_m = [0, 0, 0.05] }}\n\
         [[shape]]\nname = \"floor\"\nkind = \"half-space\"\n\
         [[shape]]\nname = \"foot\"\non = \"block/block\"\n{bed}\n\
         [[contact]]\nbetween = [\"block/block\", \"world/floor\"]\nenabled = false\n\
         [[contact]]\nbetween = [\"block/foot\", \"world/floor\"]\n\
         normal = {{ law = \"linear\", stiffness_n_per_m = 1e5, damping_n_s_per_m = 600.0 }}\n"
    )
}

const DOWN: &str = "pose = { position_m = [0, 0, -0.05], rpy_deg = [180, 0, 0] }";

fn said(bed: &str) -> String {
    let scenario = match scenario::parse(&block_with(bed), "../../beds.toml", &[]) {
        Ok(scenario) => scenario,
        Err(errors) => return errors.to_string(),
    };
    scenario::build(&scenario).err().map_or(String::new(), |errors| errors.to_string())
}

#[test]
fn block_sinks_as_deep_as_the_whole_face_is_stiff() {
    // 10 N on 1e5 N/m: 0.1 mm. A reference area of half the face makes it twice as stiff.
    for (kind, depth, touching) in [
        ("kind = \"disc-bed\"\nradius_m = 0.08\nsamples = 100", 1e-4, 100),
        ("kind = \"ring-bed\"\ninner_radius_m = 0.05\nouter_radius_m = 0.08\nsamples = 64", 1e-4, 64),
        ("kind = \"rectangle-bed\"\nsize_m = [0.2, 0.2]\nsamples = 64", 1e-4, 64),
        ("kind = \"rectangle-bed\"\nsize_m = [0.2, 0.2]\nsamples = 64\nreference_area_m2 = 0.02", 5e-5, 64),
    ] {
        settles_at(&format!("{kind}\n{DOWN}"), depth, touching);
    }
    // All six faces of the block have samples; its underside alone, of 0.04 m², is pressed.
    settles_at("kind = \"surface-bed\"\nof = \"block\"\nspacing_m = 0.025\nreference_area_m2 = 0.04", 1e-4, 64);
}

fn settles_at(bed: &str, depth: f64, touching: usize) {
    let scenario = scenario::parse(&block_with(bed), "../../beds.toml", &[]).unwrap_or_else(|e| panic!("{e}"));
    let mut world = scenario::build(&scenario).unwrap_or_else(|e| panic!("{e}")).world;
    for _ in 0..500 {
        world.advance().unwrap_or_else(|e| panic!("{e}"));
    }
    let z = world.state().bases[0].translation.z;
    assert!((0.05 - z - depth).abs() < 1e-9, "{bed}: sunk by {} m", 0.05 - z);
    assert_eq!(world.touches().count(), touching, "{bed}");
}

#[test]
fn faults_of_beds_are_named_with_their_place() {
    for (bed, fragments) in [
        ("kind = \"disc-bed\"\nradius_m = -0.1\nsamples = 100", ["beds.toml:18:", "must be greater than 0"].as_slice()),
        ("kind = \"disc-bed\"\nradius_m = 0.1\nsamples = 2", &["beds.toml:19:", "must be at least 6"]),
        ("kind = \"disc-bed\"\nradius_m = 0.1", &["`samples`"]),
        ("kind = \"ring-bed\"\ninner_radius_m = 0.2\nouter_radius_m = 0.1\nsamples = 64", &["must not exceed"]),
        ("kind = \"ring-bed\"\ninner_radius_m = 0.1\nouter_radius_m = 0.1\nsamples = 64", &["block/foot", "bed"]),
        (
            "kind = \"surface-bed\"\nof = \"blok\"\nspacing_m = 0.02",
            &["beds.toml:18:", "\"blok\"; did you mean \"block\"?"],
        ),
        ("kind = \"disk-bed\"\nradius_m = 0.1\nsamples = 64", &["did you mean \"disc-bed\"?"]),
    ] {
        let said = said(bed);
        for fragment in fragments {
            assert!(said.contains(fragment), "for\n{bed}\nexpected: {fragment}\nsaid:\n{said}");
        }
    }
}
