//! The guide's page of effects, written from the definitions: what can be added to a model, where, with which numbers, by which law.

use super::{EffectDef, Parameter, PlaceKind, Shape, models};
use std::fmt::Write;

const HEAD: &str = r#"Effects: physics beyond the nominal model, as `[[effect]]` entries of a scenario and as hypotheses of a diagnosis.

```toml
[[effect]]
name = "joint-coulomb-friction"
place = "joint:servicer/elbow_pitch"
c = 0.8
```

- An effect is one thing everywhere: an entry of the scenario, an element of the simulated world, a number to disperse in a campaign, a hypothesis of the
  [diagnosis](crate::guide::diagnosis), and an entry of its `patched.toml`.
- At its *neutral* parameters it changes no bit of a run.
- Parts that move inside a body (slosh, a flexible mode, an inner damper) change no total momentum.
- Parameters are in SI without suffix. Vectors and tensors are lists: a tensor is xx, yy, zz, xy, xz, yz.
- `place` is `joint:name`, `link:name`, `body:name` (any link), `contact:a/b` (shapes or links), `actuator:name`, `mechanism:name`, `sensor:channel` or `world`; with the vehicle in
  front (`joint:servicer/elbow`) where a name is not unique.

In the tables a parameter's neutral value is the one at which it changes nothing (`nominal`: the value that the model has without the effect; –: a parameter of
shape, another one decides). Those in italics may be left out; the neutral value, the first word or zero stands for them unless the table says another.
Of two units the first is that of a joint that turns and of a torque, the second that of a joint that slides and of a force. Symbols: q, q̇ a joint's position
and rate; v, ω a body's velocity and angular velocity; a dot is the derivative by time.

What a program wants to know of an effect it reads where this page does:

```
use softdock::scenario::effects;

let friction = effects::find("joint-viscous-friction").unwrap();
let level = friction.parameter("b").unwrap();
assert_eq!((friction.words, level.unit.turning), ("viscous friction", "N m s/rad"));
assert_eq!(effects::models().count(), 50);
```

"#;

/// Headings, and the kinds of places at which the effects below them act first.
const CHAPTERS: [(&str, &[PlaceKind]); 7] = [
    ("At joints", &[PlaceKind::Joint]),
    ("At actuators", &[PlaceKind::Actuator]),
    ("At bodies and links", &[PlaceKind::Body, PlaceKind::Link]),
    ("Everywhere", &[PlaceKind::World]),
    ("At contacts", &[PlaceKind::Contact]),
    ("At mechanisms", &[PlaceKind::Mechanism]),
    ("At sensors", &[PlaceKind::Sensor]),
];

/// The page, in Markdown.
pub fn page() -> String {
    let mut text = HEAD.to_owned();
    text += "| effect | at | parameters | is |\n| --- | --- | --- | --- |\n";
    text.extend(models().map(row));
    for (heading, places) in CHAPTERS {
        let _ = write!(text, "\n# {heading}\n");
        text.extend(models().filter(|effect| places.contains(&chapter_of(effect))).map(section));
    }
    text
}

/// An actuator stands at a joint too; what acts at a contact may be named by its body.
fn chapter_of(effect: &EffectDef) -> PlaceKind {
    let special = [PlaceKind::Actuator, PlaceKind::Contact];
    let found = special.into_iter().find(|place| effect.places.contains(place));
    found.or_else(|| effect.places.first().copied()).unwrap_or(PlaceKind::World)
}

fn places(effect: &EffectDef) -> String {
    effect.places.iter().map(|place| place.text()).collect::<Vec<_>>().join(", ")
}

fn row(effect: &EffectDef) -> String {
    let names: Vec<String> = effect.parameters.iter().map(name).collect();
    let (title, at, sentence) = (effect.name, places(effect), effect.meaning);
    format!("| [`{title}`](#{title}) | {at} | {} | {sentence} |\n", names.join(", "))
}

fn name(parameter: &Parameter) -> String {
    if parameter.is_required { format!("`{}`", parameter.name) } else { format!("*`{}`*", parameter.name) }
}

fn section(effect: &EffectDef) -> String {
    let EffectDef { name: title, meaning, words, equation, source, .. } = effect;
    let at = places(effect);
    let mut text = format!("\n## `{title}`\n\n{meaning} A report calls it {words}. At: {at}.\n\n");
    text += "| parameter | unit | range | neutral | is |\n| --- | --- | --- | --- | --- |\n";
    text.extend(effect.parameters.iter().map(parameter_row));
    let _ = write!(text, "\nLaw: {equation}\n\nSource: {source}\n");
    text
}

fn parameter_row(parameter: &Parameter) -> String {
    let unit = match parameter.unit.text() {
        none if none.is_empty() => "–".to_owned(),
        unit => unit,
    };
    let neutral = parameter.neutral;
    let numbers = match parameter.shape {
        Shape::Number | Shape::Choice(_) => "",
        Shape::Vector => "; three numbers",
        Shape::Tensor => "; six numbers",
        Shape::NumberOrVector => "; a number or three",
    };
    let (name, range, meaning) = (name(parameter), parameter.range_text(), parameter.meaning);
    format!("| {name} | {unit} | {range} | {neutral} | {meaning}{numbers} |\n")
}
