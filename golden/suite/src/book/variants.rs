//! The page of variants and base units.

use rungc_models::{Model, VARIANTS};
use rungc_syntax::DeviceClass;
use std::fmt::Write;

/// The page: a table, as the models hold it.
pub fn variants() -> String {
    let mut page = "# Variants and base units\n\nA model such as `h2u` stands for a family: it has what any PLC of the family \
                    has. `--model h2u-mtq`, or `model = \"h2u-mtq\"` in [rungc.toml](../project.md) or in a \
                    [test file](../test-files.md), holds a program to one of them: an instruction ([E0670](../checks/E0670.md)) or a device \
                    ([E0671](../checks/E0671.md)) that it lacks is an error, a terminal beyond those of the base unit \
                    a warning ([W0672](../checks/W0672.md)), since an extension module may have it. Compiled programs \
                    are the same. `rungc explain h2u-mtq` prints a variant.\n\n\
                    | name | family | inputs | outputs | pulse outputs | lacks |\n|---|---|---|---|---|---|\n"
        .to_owned();
    for variant in &VARIANTS {
        let terminals = |class: DeviceClass, count: Option<u32>| match count {
            Some(count) => format!("{} – {}", class.number(0), class.number(count - 1)),
            None => String::new(),
        };
        let (x, y) = (DeviceClass::X, DeviceClass::Y);
        let instructions = variant.lacks.concat();
        let devices = variant.lacks_devices.iter();
        let devices = devices.map(|&(class, first, last)| match first == last {
            true => class.number(first).to_string(),
            false => format!("{} – {}", class.number(first), class.number(last)),
        });
        let direction = (variant.no_direction > 0).then(|| {
            format!(
                "direction of pulses at {}",
                terminals(y, Some(variant.no_direction))
            )
        });
        let lacks: Vec<_> = instructions
            .iter()
            .map(ToString::to_string)
            .chain(devices)
            .chain(direction)
            .collect();
        // Writing to a String cannot fail.
        let _ = writeln!(
            page,
            "| `{}` | `{}` | {} | {} | {} | {} |",
            variant.name,
            Model::get(variant.model).name,
            terminals(x, variant.inputs),
            terminals(y, variant.outputs),
            terminals(y, Some(variant.pulse_outputs)),
            lacks.join(", ")
        );
    }
    page += "\nSources: h1u-h2u-programming §3.1, §3.2, §4.3.11, §8.1, §8.4 to §8.7; l01s-programming §1.3. Of L01S, `mt` has transistor outputs, `mrt` transistors at Y000 and Y001 and relays at the others.\n";
    page
}
