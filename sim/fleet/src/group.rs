//! One program and its PLCs.

use crate::engine::{At, Engine, Failed, FleetError};
use crate::format::Plcs;
use crate::schedule::Schedule;
use crate::served::{Served, Switched};
use rungc_rt::comm::service::Service;
use std::io;
use std::net::SocketAddr;

/// One program and its PLCs.
pub struct Group<'m> {
    /// Name in the file.
    pub name: String,
    /// Number of PLCs.
    pub count: u32,
    /// Number of the first, in messages.
    first: u32,
    engine: Box<dyn Engine + 'm>,
    schedule: Schedule,
    served: Option<Served>,
    /// Until when settings have been made.
    set_until_ms: Option<u64>,
    /// A client has requested STOP, which the engine does not have.
    refused_stop: bool,
}

impl<'m> Group<'m> {
    /// A group of PLCs that have just been switched on.
    pub fn new(plcs: &Plcs, engine: Box<dyn Engine + 'm>, schedule: Schedule) -> Self {
        Group {
            name: plcs.name.text.clone(),
            count: plcs.count,
            first: plcs.first,
            engine,
            schedule,
            served: None,
            set_until_ms: None,
            refused_stop: false,
        }
    }

    /// Serves the PLCs by Modbus TCP from an address on: a port for each, or for each `units` of them.
    ///
    /// # Errors
    /// The address that is not to be had, and what the system says.
    pub fn serve(
        &mut self,
        first: SocketAddr,
        units: Option<u32>,
        service: Service,
    ) -> Result<(), (SocketAddr, io::Error)> {
        self.served = Some(Served::open(self.count, first, units, service)?);
        Ok(())
    }

    /// Its first and last port, and how many there are.
    pub fn ports(&self) -> Option<(SocketAddr, SocketAddr, usize)> {
        let served = self.served.as_ref()?;
        let mut addresses = served.addresses().map_while(Result::ok);
        let first = addresses.next()?;
        let (count, last) = addresses.fold((1, first), |(count, _), last| (count + 1, last));
        Some((first, last, count))
    }

    /// The addresses of its ports, one for each.
    pub fn addresses(&self) -> Vec<SocketAddr> {
        let served = self.served.iter().flat_map(Served::addresses);
        served.map_while(Result::ok).collect()
    }

    /// Numbers of requests by clients, and of those that were rejected.
    pub fn requests(&self) -> Option<[u64; 2]> {
        self.served.as_ref().map(|served| served.requests)
    }

    /// Sets what is due, carries out the requests of clients, and begins a scan. `now_ms`: milliseconds since power-on;
    /// `scan_us`: how long the last scan took. Returns messages: clients that switch PLCs between RUN and STOP.
    pub fn begin_scan(&mut self, now_ms: u64, scan_us: u32) -> Vec<String> {
        let engine = self.engine.as_mut();
        self.schedule.due(
            self.count,
            self.set_until_ms,
            now_ms,
            &mut |plc, setting| {
                for &(at, value) in &setting.parts {
                    // Devices that the program does not store were rejected when the group was made.
                    let _ = engine.write(plc, at, value);
                }
            },
        );
        self.set_until_ms = Some(now_ms);
        let (mut requested, mut switched) = (Vec::new(), Vec::new());
        if let Some(served) = &mut self.served {
            switched = served.poll(engine, &mut |plc, running| requested.push((plc, running)));
        }
        let mut messages: Vec<_> = switched.iter().map(|it| self.switched(it)).collect();
        let engine = self.engine.as_mut();
        for (plc, running) in requested {
            let done = engine.set_running(plc, running);
            if !done && !std::mem::replace(&mut self.refused_stop, true) {
                let name = &self.name;
                messages.push(format!(
                    "{name}: a client asks for STOP, but PLCs that run 64 at once stay in RUN; write engine = \"c\" or \"interp\" to stop them"
                ));
            }
        }
        engine.begin_scan(now_ms as u32, scan_us);
        messages
    }

    fn switched(&self, switched: &Switched) -> String {
        let Switched {
            plc,
            running,
            client,
        } = switched;
        let (name, number) = (&self.name, self.first + plc);
        let state = if *running { "RUN" } else { "STOP" };
        format!("{name}: {client} switches PLC {number} to {state} (Modbus TCP)")
    }

    /// Waits for the end of the scan.
    ///
    /// # Errors
    /// The PLCs do not run any more.
    pub fn end_scan(&mut self) -> Result<(), FleetError> {
        self.engine.end_scan()
    }

    /// The devices of its PLCs between two scans.
    pub fn engine(&mut self) -> &mut (dyn Engine + 'm) {
        self.engine.as_mut()
    }

    /// Returns true if the program stores a device.
    pub fn has(&mut self, at: At) -> bool {
        self.engine.read(0, at).is_some()
    }

    /// Its line of the summary, without the name.
    pub fn what(&self) -> String {
        self.engine.what()
    }

    /// Number of its PLCs in STOP.
    pub fn stopped(&mut self) -> u32 {
        self.engine.stopped(self.count)
    }

    /// The operation errors of its PLCs, and what stopped them.
    pub fn failures(&mut self) -> Vec<Failed> {
        self.engine.failures()
    }

    /// The processes that it consists of beside this one.
    pub fn children(&self) -> Vec<u32> {
        self.engine.children()
    }
}
