//! Answers are held to what the interpreter does.

mod blame;
mod subjects;
mod ways;
