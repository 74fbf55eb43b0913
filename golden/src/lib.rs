//! Conformance cases, example programs and the tests that run them on every engine; the crate itself is empty.
