//! One function per instruction, in files by the manual's families.

pub(crate) mod digits;
mod output;

pub mod axes;
pub mod axis_cam;
pub mod axis_follow;
pub mod axis_home;
pub mod axis_jog;
mod axis_registers;
pub mod block;
pub mod can;
pub mod canlink;
pub mod cassette;
pub mod clock;
pub mod cut;
pub mod data;
pub mod display;
pub mod exchange;
pub mod float;
pub mod handy;
pub mod keys;
pub mod modbus;
pub mod modules;
pub mod move_;
pub mod pid;
pub mod pid_thermal;
pub mod position;
pub mod pulses;
pub mod rotate;
pub mod scale;
pub mod scope;
pub mod segment;
pub mod serial;
pub mod servo;
pub mod supply;
pub mod system;
pub mod table;
pub mod text;

#[cfg(test)]
mod random_tests;
