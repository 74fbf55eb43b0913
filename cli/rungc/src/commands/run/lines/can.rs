//! A CAN interface of this machine (SocketCAN). The port sees its frames as an adapter writes them, as SLCAN.

use can_socket::{CanData, CanFrame, CanId, CanSocket, ExtendedId, StandardId};
use rungc_rt::comm::{self, Frame};
use rustix::io::Errno;
use rustix::net::sockopt::{Timeout, set_socket_timeout};
use std::io;
use std::os::fd::AsFd;
use std::time::Duration;

/// An open interface.
#[derive(Debug)]
pub struct Interface(CanSocket);

impl Interface {
    /// Opens the interface that has this name. `patience` is how long reading waits, `write_wait` sending.
    ///
    /// # Errors
    /// What the system says: there is no such interface, or it is not one of CAN.
    pub fn open(name: &str, patience: Duration, write_wait: Duration) -> io::Result<Self> {
        let socket = CanSocket::bind(name)?;
        set_socket_timeout(&socket, Timeout::Recv, Some(patience))?;
        set_socket_timeout(&socket, Timeout::Send, Some(write_wait))?;
        Ok(Interface(socket))
    }

    pub fn try_clone(&self) -> io::Result<Self> {
        let socket = self.0.as_fd().try_clone_to_owned()?;
        Ok(Interface(socket.into()))
    }

    /// The next frame as characters. A request for a frame, which carries no data, is none.
    ///
    /// # Errors
    /// What the system says; an interruption when there is nothing to report yet.
    pub fn read(&self, buffer: &mut [u8]) -> io::Result<usize> {
        let came = self.0.recv()?;
        let Some(frame) = from_system(&came) else {
            return Err(io::ErrorKind::Interrupted.into());
        };
        let mut text = Frame::new(buffer);
        frame.write(&mut text);
        Ok(text.as_slice().len())
    }

    /// Sends the whole frames at the beginning of `bytes`; how many characters have been dealt with. What is not a
    /// frame is skipped.
    ///
    /// # Errors
    /// What the system says, if no frame went out.
    pub fn write(&self, bytes: &[u8]) -> io::Result<usize> {
        let mut done = 0;
        for line in bytes.split_inclusive(|&byte| byte == b'\r') {
            if !line.ends_with(b"\r") {
                break;
            }
            if let Some(frame) = comm::CanFrame::parse(line).and_then(to_system) {
                match self.0.send(&frame) {
                    Ok(()) => {}
                    Err(_) if done > 0 => break,
                    // The queue of the interface is full.
                    Err(error) if error.raw_os_error() == Some(Errno::NOBUFS.raw_os_error()) => {
                        return Ok(0);
                    }
                    Err(error) => return Err(error),
                }
            }
            done += line.len();
        }
        Ok(done)
    }
}

/// A frame of the system as the port knows it.
fn from_system(frame: &CanFrame) -> Option<comm::CanFrame> {
    let bytes = frame.data()?;
    let mut data = [0; 8];
    let place = data.get_mut(..bytes.as_slice().len())?;
    place.copy_from_slice(bytes.as_slice());
    Some(comm::CanFrame {
        id: match frame.id() {
            CanId::Standard(id) => id.as_u16().into(),
            CanId::Extended(id) => id.as_u32() | comm::CanFrame::EXTENDED,
        },
        len: bytes.as_slice().len() as u8,
        data,
    })
}

/// The same the other way.
fn to_system(frame: comm::CanFrame) -> Option<CanFrame> {
    let number = frame.id & !comm::CanFrame::EXTENDED;
    let id = match frame.id & comm::CanFrame::EXTENDED {
        0 => CanId::Standard(StandardId::try_from(number).ok()?),
        _ => CanId::Extended(ExtendedId::try_from(number).ok()?),
    };
    let bytes = frame.data.get(..frame.len.into())?;
    Some(CanFrame::new(id, CanData::try_from(bytes).ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_come_back_as_they_were() {
        for id in [0x200, 0x7ff, 0x134f_0200 | comm::CanFrame::EXTENDED] {
            for len in [0, 3, 8] {
                let mut data = [0; 8];
                data[..len].copy_from_slice(&[1, 2, 3, 4, 5, 6, 7, 8][..len]);
                let frame = comm::CanFrame {
                    id,
                    len: len as u8,
                    data,
                };
                assert_eq!(to_system(frame).as_ref().and_then(from_system), Some(frame));
            }
        }
    }

    #[test]
    fn an_interface_that_is_not_there() {
        let opened = Interface::open("nocan9", Duration::from_millis(1), Duration::from_millis(1));
        assert!(opened.is_err());
    }
}
