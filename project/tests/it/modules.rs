//! Analog adapters and boards of FX in settings.

use crate::common::parse;
use rungc_models::{Model, ModelId};
use rungc_project::Error;
use std::path::Path;

#[test]
fn adapters_and_boards_need_no_number() {
    let text = "[[module]]\nkind = \"FX3U-4AD-ADP\"\n[[module]]\nat = 0\nkind = \"FX3U-4AD\"\n\
                [[module]]\nkind = \"FX3U-4DA-ADP\"\n[[module]]\nkind = \"FX3G-2AD-BD\"\n";
    let project = parse(text).unwrap();
    let units: Vec<_> = project.modules.iter().map(|row| row.unit).collect();
    assert_eq!(units, [202, 0, 203, 200]);
    for (at, kind) in [
        ("at = 0\n", "FX3U-4AD-ADP"),
        ("at = \"board\"\n", "FX3U-4AD-ADP"),
        ("at = 1\n", "FX3G-1DA-BD"),
        ("at = \"adapter1\"\n", "FX3U-4AD"),
        ("", "FX3U-4AD"),
    ] {
        let text = format!("[[module]]\n{at}kind = \"{kind}\"\n");
        assert!(parse(&text).is_err(), "{text}");
    }
    let twice = "[[module]]\nat = \"adapter1\"\nkind = \"FX3U-3A-ADP\"\n".repeat(2);
    let five = "[[module]]\nkind = \"FX3U-3A-ADP\"\n".repeat(5);
    assert!(parse(&twice).is_err() && parse(&five).is_err());
}

#[test]
fn adapters_and_boards_fit_models_that_have_their_devices() {
    for (at, kind, id, message) in [
        ("adapter4", "FX3U-4AD-ADP", ModelId::Fx3u, None),
        ("adapter1", "FX3U-4AD-TC-ADP", ModelId::Fx3s, None),
        ("board2", "FX3G-2AD-BD", ModelId::Fx3g, None),
        ("board", "FX1N-1DA-BD", ModelId::Fx1s, None),
        (
            "adapter3",
            "FX3U-4DA-ADP",
            ModelId::Fx3g,
            Some("Mitsubishi FX3G has no place for adapter3"),
        ),
        (
            "board2",
            "FX3G-1DA-BD",
            ModelId::Fx3s,
            Some("Mitsubishi FX3S has no place for board2"),
        ),
        (
            "board",
            "FX3G-1DA-BD",
            ModelId::Fx3u,
            Some("FX3G-1DA-BD does not fit Mitsubishi FX3U"),
        ),
        (
            "adapter1",
            "FX3U-3A-ADP",
            ModelId::Fx3uCompatible,
            Some("FX3U-3A-ADP does not fit FX3U-compatible board"),
        ),
    ] {
        let project = parse(&format!("[[module]]\nat = \"{at}\"\nkind = \"{kind}\"\n")).unwrap();
        let mut program = rungc_frontend::read_text("p.il", "END\n").program;
        let fits = project.complete(Path::new("plant/p.il"), &mut program, Model::get(id));
        let why = match fits {
            Err(Error::Invalid { diagnostics, .. }) => {
                diagnostics.iter().next().map(|d| d.message.clone())
            }
            _ => None,
        };
        assert_eq!(why.as_deref(), message, "{at} {kind}");
    }
}
