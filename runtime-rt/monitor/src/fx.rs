//! A PLC at its programming port.

use crate::plan::{Block, plan};
use crate::{Client, Error, Item, Line, Patience, Reply, Sample};
use rungc_rt::comm::fx_port::Space;

/// Request for the PLC's type and version.
const TYPE: &[u8] = b"00E0202";
/// M8000, by a command that only FX3 knows.
const FX3_ONLY: &[u8] = b"F50100060";

/// Types by D8001 in thousands, and whether the PLC knows FX3's commands: the CPU type as the editors spell it.
const TYPES: [(u16, bool, &str); 6] = [
    (22, false, FX1S),
    (26, false, "FX1N/FX1NC"),
    (24, false, "FX2N/FX2NC"),
    (28, true, "FX3S"),
    (26, true, "FX3G"),
    (24, true, "FX3U/FX3UC"),
];

/// The type that has the basic commands alone.
const FX1S: &str = "FX1S";

/// A PLC that has answered.
pub struct Plc<L> {
    client: Client<L>,
    type_code: u16,
    cpu: Option<&'static str>,
    is_fx3: bool,
}

impl<L: Line> Plc<L> {
    /// Asks a PLC for its type.
    ///
    /// # Errors
    /// No PLC answers on the line.
    pub fn connect(line: L, patience: Patience) -> Result<Plc<L>, Error> {
        let mut client = Client::new(line, patience);
        client.greet()?;
        let code = client.data(TYPE, 2)?;
        let [low, high] = code.as_deref().unwrap_or_default() else {
            let why = "the PLC does not show its type in D8001";
            return Err(client.failure(why));
        };
        let type_code = u16::from_le_bytes([*low, *high]);
        let is_fx3 = matches!(client.request(FX3_ONLY)?, Reply::Data(_));
        let known = TYPES.iter();
        let mut known = known.filter(|(code, ..)| *code == type_code / 1000);
        let exact = known.clone().find(|(_, fx3, _)| *fx3 == is_fx3);
        let cpu = exact.or_else(|| known.next()).map(|(.., cpu)| *cpu);
        Ok(Plc {
            client,
            type_code,
            cpu,
            is_fx3,
        })
    }

    /// The CPU type as the editors spell it, if it is known.
    pub fn cpu(&self) -> Option<&'static str> {
        self.cpu
    }

    /// True if the PLC has the basic commands alone.
    pub fn is_basic(&self) -> bool {
        self.cpu == Some(FX1S)
    }

    /// The asking end.
    pub fn client(&mut self) -> &mut Client<L> {
        &mut self.client
    }

    /// Name for users.
    pub fn title(&self) -> String {
        match self.cpu {
            Some(cpu) => format!("{cpu} (D8001 = {})", self.type_code),
            None => format!("a PLC of unknown type (D8001 = {})", self.type_code),
        }
    }

    /// Reads values, neighbours in one request. What the PLC rejects is hidden, as is what its port does not reach: on
    /// most models R, and the special registers from D8256 on.
    ///
    /// # Errors
    /// No answer, or none that is whole.
    pub fn read(&mut self, items: impl IntoIterator<Item = Item>) -> Result<Sample, Error> {
        let space = match (self.is_basic(), self.is_fx3) {
            (true, _) => Space::Basic,
            (false, true) => Space::Fx3,
            (false, false) => Space::Fx2n,
        };
        let (blocks, hidden) = plan(items, space);
        let mut sample = Sample {
            hidden,
            ..Sample::default()
        };
        for block in blocks {
            let bytes = self.block(&block)?;
            for &(item, place) in &block.places {
                let value = bytes.as_deref().and_then(|bytes| block.value(place, bytes));
                sample.enter(item, value);
            }
        }
        Ok(sample)
    }

    fn block(&mut self, block: &Block) -> Result<Option<Vec<u8>>, Error> {
        let command = if self.is_basic() { "0" } else { "E00" };
        let request = format!("{command}{:04X}{:02X}", block.address, block.count);
        self.client.data(request.as_bytes(), block.count as usize)
    }
}
