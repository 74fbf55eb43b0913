//! The hardware that a program runs on: special modules and the clock.

use rungc_rt::{Clock, Hal, VirtualHal, modules};
use rungc_syntax::FittedModule;

/// Hardware with these special modules, whose real-time clock shows the local time in a run that keeps step with it.
pub fn of(in_real_time: bool, fitted: &[FittedModule]) -> VirtualHal {
    let mut hal = VirtualHal::new();
    if in_real_time {
        // Without a time zone it keeps its own time.
        let _ = local_time().and_then(|clock| hal.set_clock(clock));
    }
    for module in fitted {
        // The settings name each number once, kinds that are known, and no more modules than there is room for.
        let _ = modules::Kind::find(module.kind).and_then(|kind| hal.fit(module.unit, kind));
        let _ = hal.delay_module(module.unit, module.delay_ms);
    }
    hal
}

/// The local time: that of the zone which the system or `TZ` names.
fn local_time() -> Option<Clock> {
    let named = std::env::var("TZ").ok().filter(|name| !name.is_empty());
    let zone = match named {
        Some(name) => tz::TimeZone::from_posix_tz(&name),
        None => tz::TimeZone::local(),
    };
    let zone = zone.ok()?;
    let now = tz::DateTime::now(zone.as_ref()).ok()?;
    Clock::new(
        u16::try_from(now.year()).ok()?,
        now.month(),
        now.month_day(),
        now.hour(),
        now.minute(),
        now.second(),
    )
}
