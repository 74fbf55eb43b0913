//! Rows with `use`.

use super::{lines, mistakes, read};
use std::path::Path;

const HERE: &str = "";

fn expanded(text: &str) -> String {
    lines(&read(Path::new(HERE), text).unwrap())
}

fn wrong(text: &str) -> String {
    mistakes(Path::new(HERE), text)
}

#[test]
fn demands_become_properties() {
    let text = "[[property]]\nuse = 'two-hand'\nname = 'press'\nleft = '!x0'\nright = 'X1 | X2'\n\
                output = ['y0', 'press down']\n[[property]]\nnever = 'Y7'\n";
    insta::assert_snapshot!(expanded(text));
}

#[test]
fn demands_without_their_parameters_are_left_out() {
    let text = "[[property]]\nuse = 'level'\nlow = 'D0 < 100'\nhigh = 'D0 >= 400'\noutput = 'Y0'\nwithin = 300\n";
    let short = expanded(text);
    let long = expanded(&format!("{text}stop = 'X2'\n"));
    insta::assert_snapshot!(format!("{short}\n{long}"));
}

#[test]
fn demands_are_repeated_over_lists() {
    let text = "[[property]]\nuse = 'sequence'\nsteps = ['S0', 'S20', 'S21']\nstart = 'X0'\n";
    insta::assert_snapshot!(expanded(text));
}

#[test]
fn mistakes_have_a_place() {
    let texts = [
        "[[property]]\nuse = 'two-hands'\n",
        "[[property]]\nuse = 'pedal'\n",
        "[[property]]\nuse = 'two-hand'\nlft = 'X0'\nright = 'X1'\noutput = 'Y0'\n",
        "[[property]]\nuse = 'two-hand'\nleft = 'X0'\nright = ' x000 '\noutput = 'Y0'\n",
        "[[property]]\nuse = 'two-hand'\nleft = 'X0'\nright = 'X1'\noutput = 'X2'\nwithin = '5 hours'\n",
        "[[property]]\nuse = 'two-hand'\nleft = 'X0'\nright = 'X1'\noutput = 'D2'\nbutton = 'X7'\n",
        "[[property]]\nuse = 'two-hand'\nleft = ['X0', 'X3']\nright = 'X1'\noutput = []\n",
        "[[property]]\nuse = 'two-hand'\nleft = 'X0'\nright = 'X1'\noutput = 'Y0 & Y1'\n",
        "[[property]]\nuse = 'mode-selection'\nmodes = 'M0'\noutput = ['Y0', 'y000']\nstart = 'X0'\n",
    ];
    insta::assert_snapshot!(texts.map(wrong).join("\n"));
}
