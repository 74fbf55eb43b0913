//! Tests of the crate from outside, one module for each area.

mod arm_linux;
mod assistants;
mod boards;
mod book;
#[cfg(all(unix, feature = "mqtt"))]
mod brokers;
mod browser;
mod builds;
mod command_line;
mod common;
#[cfg(unix)]
mod connected;
mod conversions;
mod coverage;
mod debugging;
mod deep;
mod demo;
mod diff;
#[cfg(unix)]
mod doctor;
mod documents;
#[cfg(unix)]
mod editors;
mod embedded;
#[cfg(unix)]
mod executables;
mod explore;
mod firmware;
#[cfg(unix)]
mod flash;
#[cfg(unix)]
mod fleet;
mod hostile;
mod images;
#[cfg(unix)]
mod interrupted;
mod languages;
mod large;
mod learn;
mod library;
#[cfg(unix)]
mod lines;
#[cfg(unix)]
mod linux;
mod listings;
mod live;
#[cfg(unix)]
mod mingw;
mod names;
mod offline;
mod outputs;
#[cfg(unix)]
mod peers;
mod plcopen;
mod port_cost;
mod project;
mod projects;
#[cfg(unix)]
mod read;
mod rename;
mod reports;
mod results;
mod retain;
mod run;
#[cfg(unix)]
mod serve;
mod servers;
mod sessions;
mod settings_files;
mod several;
mod sources;
mod threads;
mod together;
mod tools;
#[cfg(unix)]
mod uart;
mod usage;
mod vendor;
mod verify;
mod view;
mod watch;
mod why;
