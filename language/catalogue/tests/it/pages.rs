//! Pages about an instruction on one model.

use rungc_catalogue::{all, explain_on, find};
use rungc_models::plc_errors;
use rungc_models::runs::is_special;
use rungc_models::{Model, ModelId, Plc};
use rungc_syntax::DeviceClass;

fn page(name: &str, plc: &str) -> String {
    explain_on(name, Plc::named(plc).unwrap()).unwrap()
}

/// Devices that a text names, of a run those at its ends.
fn devices(text: &str) -> impl Iterator<Item = (DeviceClass, u32)> {
    let words = text.split(|c: char| !c.is_ascii_alphanumeric());
    words.filter_map(|word| {
        let (prefix, digits) = word.split_at(word.find(|c: char| c.is_ascii_digit())?);
        let class = DeviceClass::from_prefix(prefix)?;
        let radix = if class.is_octal() { 8 } else { 10 };
        Some((class, u32::from_str_radix(digits, radix).ok()?))
    })
}

#[test]
fn pages_of_a_model_name_its_devices_and_errors() {
    let mut wrong = Vec::new();
    for model in ModelId::ALL.map(Model::get) {
        for inst in all().filter(|inst| inst.models.has(model.id)) {
            let page = page(inst.name, model.name);
            // Names of operands look like devices: D1, S2.
            let cells = page.split('|').filter(|cell| cell.trim().len() > 2);
            for word in cells.flat_map(str::split_whitespace) {
                for (class, number) in devices(word) {
                    let alone = is_special(class, number) && !word.contains('–');
                    let known = match alone {
                        true => model.special(class, number).is_some(),
                        false => model.has(class, number),
                    };
                    if !known {
                        wrong.push(format!("{} {} {word}", model.name, inst.name));
                    }
                }
            }
            let errors = page.split("## Errors").nth(1).unwrap_or_default();
            for line in errors.lines().filter_map(|line| line.strip_prefix("- ")) {
                let code = line.split(':').next().unwrap().parse().unwrap();
                assert!(
                    plc_errors::find(code, model.id).is_some(),
                    "{} {line}",
                    inst.name
                );
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// 6750 is a module on H1U and H2U, and auto tuning on FX, where a module that cannot be reached is 6708.
#[test]
fn errors_have_the_codes_of_the_model() {
    let listed = |name: &str, plc: &str| -> Vec<u16> {
        let page = page(name, plc);
        let errors = page.split("## Errors").nth(1).unwrap_or_default();
        let lines = errors.lines().filter_map(|line| line.strip_prefix("- "));
        lines
            .map(|line| line.split(':').next().unwrap().parse().unwrap())
            .collect()
    };
    let settings = [6730, 6732, 6733, 6734, 6735, 6736];
    let values = [6740, 6742, 6743, 6744, 6745, 6746, 6747];
    let pid = |before: &[u16], after: &[u16]| [before, &settings, &values, after].concat();
    assert_eq!(listed("PID", "h2u"), pid(&[6706], &[]));
    assert_eq!(listed("PID", "fx2n"), pid(&[6706], &[6750, 6751]));
    let fx3 = pid(&[6706, 6708], &[6748, 6749, 6750, 6751]);
    assert_eq!(listed("PID", "fx3u"), fx3);
    assert_eq!(listed("PID", "l01s"), [6706, 6730, 6732]);
    assert!(listed("FROM", "h2u").contains(&6750));
    assert!(listed("FROM", "fx3u").contains(&6708) && !listed("FROM", "fx3u").contains(&6750));
    let all = rungc_catalogue::explain("PID").unwrap();
    let line = "\n- 6750: auto tuning of PID has no result (only on fx1s, fx1n, fx2n, ";
    assert!(all.contains(line), "{all}");
}

#[test]
fn an_instruction_that_a_model_lacks_is_said_so() {
    for model in ModelId::ALL.map(Model::get) {
        for inst in all() {
            let page = page(inst.name, model.name);
            let lacks = format!("{} does not have {}.", model.title, inst.name);
            assert_eq!(
                page.contains(&lacks),
                !inst.models.has(model.id),
                "{} {}",
                model.name,
                inst.name
            );
        }
    }
    let eadd = page("EADD", "fx1s");
    assert!(eadd.contains("These models have it: h1u, h2u, "), "{eadd}");
    assert!(!eadd.contains("## Operands"), "{eadd}");
}

#[test]
fn pages_of_a_model_show_what_holds_there() {
    let found = find("DADDP").unwrap();
    assert_eq!(found.inst.name, "ADD");
    insta::assert_snapshot!("mov_fx1s", page("MOV", "fx1s"));
    insta::assert_snapshot!("mov_fx3u", page("MOV", "fx3u"));
    insta::assert_snapshot!("out_fx3u", page("OUT", "fx3u"));
    insta::assert_snapshot!("out_fx1s", page("OUT", "fx1s"));
    insta::assert_snapshot!("plsy_fx3g", page("PLSY", "fx3g"));
    insta::assert_snapshot!("rs_fx2n", page("RS", "fx2n"));
    insta::assert_snapshot!("fmov_hm", page("FMOV", "hm"));
    insta::assert_snapshot!("from_fx1n", page("FROM", "fx1n"));
}
