//! The ladder of a program: what its instructions draw, and drawing it.
//!
//! [`build::ladder`] turns the instructions into [`Network`]s of series and parallel contacts, branches and outputs;
//! [`list::instructions`] is its inverse. [`layout::lay_out`] places a network on a grid of rows and columns as the
//! editors do; [`text::draw`] draws the grid in characters, [`svg::draw`] as a picture, and [`html::page`] makes a page
//! of all pictures. [`circuit::Circuit`] says where power flows in a picture. This crate knows neither files nor output
//! languages nor what an instruction does. Start reading at [`Network`].

pub mod build;
pub mod circuit;
pub mod compare;
pub mod drawing;
pub mod html;
pub mod layout;
pub mod list;
pub mod pdf;
pub mod sfc;
pub mod svg;
pub mod text;

mod condition;
mod face;
mod network;
mod picture;

pub use network::{
    Branch, Contact, InstrIndex, Item, Join, Ladder, Network, NetworkBody, Node, Output, Part,
    Series, Shape,
};
