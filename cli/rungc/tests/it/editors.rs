//! `rungc lsp` under clients that others have written: pytest-lsp, and Neovim if it is there.

use crate::common::clients::{client, python, succeeds, there};
use crate::common::folder;
use std::process::Command;

#[test]
fn pytest_lsp_edits_a_list() {
    let Some(mut editor) = python("pytest_lsp", "editor.py") else {
        return;
    };
    let folder = folder(&[("rungc.toml", b"[project]\nmodel = \"fx3u\"\n")]);
    editor.arg(env!("CARGO_BIN_EXE_rungc")).arg(folder.path());
    succeeds(editor);
}

/// A list with an error and wide characters, which `clients/editor.lua` edits.
const LIST: &str = "\
;! X000 = 启动按钮 😀
LD X000 ; 按下 😀
MOV 0x1F D10
LD> D10 K5
OUT Y000
END
";

#[test]
fn neovim_edits_a_list() {
    let mut nvim = Command::new("nvim");
    nvim.arg("--version");
    if !there("nvim", "RUNGC_REQUIRE_PEERS", nvim) {
        return;
    }
    let folder = folder(&[("press.il", LIST.as_bytes())]);
    let script = client("editor.lua");
    let mut nvim = Command::new("nvim");
    nvim.args(["--headless", "--clean", "-c"])
        .arg(format!("luafile {}", script.display()))
        .env("RUNGC", env!("CARGO_BIN_EXE_rungc"))
        .env("LIST", folder.path().join("press.il"));
    succeeds(nvim);
}
