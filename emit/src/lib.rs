//! The emission plan: every decision about a program that does not depend on the language it is printed in.
//!
//! The crate lies between the IR and the backends. It decides how devices are stored ([`storage`]), and it knows no syntax of any
//! output language: a backend prints what stands here, and decides nothing about what a program means.
//!
//! Start reading at [`storage::Storage`].

pub mod storage;
