//! The tables of a description, as TOML has them.

use serde::Deserialize;
use toml::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawMachine {
    #[serde(default)]
    pub(super) axis: Vec<Spanned<RawAxis>>,
    #[serde(default)]
    pub(super) cylinder: Vec<Spanned<RawCylinder>>,
    #[serde(default)]
    pub(super) delay: Vec<Spanned<RawDelay>>,
    #[serde(default)]
    pub(super) process: Vec<Spanned<RawProcess>>,
    #[serde(default)]
    pub(super) normally_closed: Vec<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawAxis {
    pub(super) name: Option<Spanned<String>>,
    pub(super) unit: Option<String>,
    pub(super) pulses_per_unit: Option<Spanned<f64>>,
    pub(super) output: Option<Spanned<String>>,
    pub(super) direction: Option<Spanned<String>>,
    pub(super) direction_on: Option<Spanned<RawDirection>>,
    pub(super) forward: Option<Spanned<String>>,
    pub(super) reverse: Option<Spanned<String>>,
    pub(super) speed: Option<Spanned<f64>>,
    pub(super) start: Option<Spanned<f64>>,
    pub(super) travel: Option<Spanned<Vec<f64>>>,
    pub(super) home: Option<Spanned<String>>,
    pub(super) home_at: Option<Spanned<Vec<f64>>>,
    pub(super) forward_limit: Option<Spanned<String>>,
    pub(super) forward_limit_at: Option<Spanned<f64>>,
    pub(super) reverse_limit: Option<Spanned<String>>,
    pub(super) reverse_limit_at: Option<Spanned<f64>>,
    pub(super) zero_phase: Option<Spanned<String>>,
    pub(super) zero_phase_every: Option<Spanned<f64>>,
    pub(super) encoder: Option<RawEncoder>,
    #[serde(default)]
    pub(super) switch: Vec<RawSwitch>,
    #[serde(default)]
    pub(super) sensor: Vec<RawSensor>,
}

#[derive(Deserialize, Clone, Copy)]
#[serde(rename_all = "lowercase")]
pub(super) enum RawDirection {
    Forward,
    Reverse,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawEncoder {
    pub(super) a: Spanned<String>,
    pub(super) b: Spanned<String>,
    pub(super) cycles_per_unit: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawSwitch {
    pub(super) input: Spanned<String>,
    pub(super) at: Spanned<Vec<f64>>,
    pub(super) every: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawCylinder {
    pub(super) extend: Spanned<String>,
    pub(super) retract: Option<Spanned<String>>,
    pub(super) extended: Option<Spanned<String>>,
    pub(super) retracted: Option<Spanned<String>>,
    pub(super) time_ms: Spanned<u32>,
    pub(super) retract_ms: Option<Spanned<u32>>,
    pub(super) start: Option<RawEnd>,
}

#[derive(Deserialize, Clone, Copy, PartialEq)]
#[serde(rename_all = "lowercase")]
pub(super) enum RawEnd {
    Retracted,
    Extended,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawDelay {
    pub(super) output: Spanned<String>,
    pub(super) input: Spanned<String>,
    pub(super) on_ms: Option<Spanned<u32>>,
    pub(super) off_ms: Option<Spanned<u32>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawProcess {
    pub(super) name: Spanned<String>,
    pub(super) unit: Option<String>,
    pub(super) drive: Spanned<String>,
    pub(super) drive_signal: Option<Spanned<Vec<f64>>>,
    #[serde(default)]
    pub(super) rest: f64,
    pub(super) full: f64,
    pub(super) start: Option<f64>,
    pub(super) time_constant_s: Spanned<f64>,
    pub(super) dead_time_s: Option<Spanned<f64>>,
    #[serde(default)]
    pub(super) sensor: Vec<RawSensor>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawSensor {
    pub(super) channel: Spanned<String>,
    pub(super) range: Option<Spanned<Vec<f64>>>,
    pub(super) signal: Option<Spanned<Vec<f64>>>,
}
