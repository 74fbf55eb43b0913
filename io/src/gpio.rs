//! The pins of this machine, by the character device of Linux.

use gpiocdev::Request;
use gpiocdev::line::{Bias, Drive, Value, Values};
use rungc_rt::io::{Connection, Driver, End, Row, Trouble};

/// The lines of a connection: those that are read and those that are driven.
struct Pins {
    inputs: Option<Request>,
    outputs: Option<Request>,
}

/// Takes the lines of a chip: `/dev/gpiochip0`.
pub fn open(connection: &Connection) -> Result<Box<dyn Driver>, String> {
    Ok(Box::new(Pins {
        inputs: request(connection, true)?,
        outputs: request(connection, false)?,
    }))
}

/// The line of a row.
fn line(row: &Row) -> (u32, &[String]) {
    match &row.end {
        End::Line { offset, flags } => (*offset, flags),
        _ => (0, &[]),
    }
}

/// Takes the lines of a direction; nothing if there are none.
fn request(connection: &Connection, reads: bool) -> Result<Option<Request>, String> {
    if connection.values(reads) == 0 {
        return Ok(None);
    }
    let mut builder = Request::builder();
    builder.on_chip(&connection.end).with_consumer("rungc");
    for row in connection.directed(reads) {
        let (offset, flags) = line(row);
        builder.with_line(offset);
        match reads {
            true => builder.as_input(),
            false => builder.as_output(Value::Inactive),
        };
        // Settings also apply to the next line of a request unless they are set there.
        let has = |flag: &str| flags.iter().any(|other| other == flag);
        match has("active-low") {
            true => builder.as_active_low(),
            false => builder.as_active_high(),
        };
        builder.with_bias(match (has("pull-up"), has("pull-down")) {
            (true, _) => Some(Bias::PullUp),
            (_, true) => Some(Bias::PullDown),
            _ => None,
        });
        if !reads {
            builder.with_drive(match has("open-drain") {
                true => Drive::OpenDrain,
                false => Drive::PushPull,
            });
        }
    }
    builder
        .request()
        .map(Some)
        .map_err(|error| error.to_string())
}

impl Driver for Pins {
    fn exchange(
        &mut self,
        connection: &Connection,
        inputs: &mut [i16],
        outputs: &[i16],
    ) -> Result<(), Trouble> {
        let lost = |error: gpiocdev::Error| Trouble::Lost(error.to_string());
        if let Some(request) = &self.inputs {
            let offsets = connection.directed(true).map(|row| line(row).0);
            let mut values = Values::from_offsets(&offsets.collect::<Vec<_>>());
            request.values(&mut values).map_err(lost)?;
            for row in connection.directed(true) {
                let is_on = values.get(line(row).0) == Some(Value::Active);
                inputs[row.place.start] = i16::from(is_on);
            }
        }
        if let Some(request) = &self.outputs {
            let mut values = Values::default();
            for row in connection.directed(false) {
                let value = Value::from(outputs[row.place.start] != 0);
                values.set(line(row).0, value);
            }
            request.set_values(&values).map_err(lost)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_chip_is_not_opened() {
        for chip in ["/dev/gpiochip-none", "/dev/null", "/etc/hostname", "/dev"] {
            let pairs = [
                ("gpio", chip),
                ("X000", "read 17 pull-up"),
                ("Y000", "write 22"),
            ];
            let connection = Connection::read("pins", &pairs).unwrap();
            assert!(open(&connection).is_err(), "{chip}");
        }
    }
}
