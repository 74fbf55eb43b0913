//! Data processing: FNC 40–49, h1u-h2u-programming §4.3.5.

use crate::cx::Cx;
use crate::fault::Done;
use crate::special::M_ZERO;

/// SUM S D (FNC 43): the number of one-bits of S goes to D; M8020 is on if there are none.
pub fn sum(cx: &mut Cx) -> Done {
    let ones = if cx.wide() {
        cx.read(0)?.count_ones()
    } else {
        (cx.read(0)? as u16).count_ones()
    };
    cx.write(1, ones as i32)?;
    cx.set_special(M_ZERO, ones == 0);
    Ok(())
}
