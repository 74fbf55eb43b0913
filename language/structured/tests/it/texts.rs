//! Texts of users.
