//! The emission plan: every decision about a program that does not depend on the language it is printed in.
//!
//! The crate lies between the IR and the backends. It decides how devices are stored ([`storage`]), how a program is
//! divided into functions of bounded size ([`plan`]), where its temporaries live and what they are called ([`temps`]),
//! which parts of expressions get a name ([`parts`]) what a loop over stations reads before its first iteration
//! ([`stations`]), what happens around the program's functions ([`cycle`], [`events`]), what it remembers in addition
//! to its devices ([`private`]), what comments say ([`comments`]) and which options its main program takes ([`usage`]).
//! It knows no syntax of any output language: a backend prints what is here, and decides nothing about what a program
//! means.
//!
//! Start reading at [`plan::Plan`] and [`storage::Storage`].

#![deny(clippy::wildcard_enum_match_arm)]

pub mod areas;
pub mod bounds;
pub mod comments;
pub mod cycle;
pub mod edges;
pub mod events;
mod file;
pub mod logic;
pub mod measure;
pub mod parts;
pub mod plan;
pub mod private;
pub mod stations;
pub mod steps;
pub mod storage;
pub mod temps;
pub mod timers;
pub mod usage;

pub use file::OutFile;
