//! Structured text as users have it: what is wrong with it, what becomes of it, and how that compares with what the
//! vendor's compiler makes.

mod behaviour;
mod files;
mod model;
mod random;
mod robust;
mod texts;
mod texts_by_chance;
