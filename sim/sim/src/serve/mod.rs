//! Traffic of the servers and serial ports of a running PLC: it is decoded ([`Decoder`]) and counted ([`Traffic`]). The
//! servers themselves are those of [`rungc_host::servers`].

mod decode;
mod probe;
mod traffic;

pub use decode::{Decoded, Decoder, Direction, LinkProtocol};
pub use traffic::{Place, Seen, Traffic};
