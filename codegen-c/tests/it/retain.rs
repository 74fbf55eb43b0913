//! Latched devices that survive power-off: what a save leaves when power fails at any byte of it.

use crate::build::{STRICT, compilers};
use rungc_codegen_c::{Options, emit};
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use std::process::Command;

/// Latched devices of each kind, those of stations in a grid among them.
const LIST: &str = "LD X0\nOUT T250 K5\nLD X1\nOUT C100 K3\nLD X1\nOUT C220 K70000\nLD M500\nMOV D200 D201\nDMOV D202 D204\n\
    LD X2\nCJ P1\nLD X3\nRST C100\nRST C220\nP1\n";

/// A program with flash that loses its supply after some bytes. The byte in work then keeps some of its bits.
const CHECKS: &str = r#"
#include "probe_retain.h"
#include <stdio.h>
#include <stdlib.h>

#define SLOT 2048u

typedef struct cells {
    uint8_t slots[2][SLOT];
    uint32_t left;
    uint8_t torn;
    unsigned erasures;
} cells;

static void fail(const char *what, int line)
{
    printf("line %d: %s\n", line, what);
    exit(1);
}
#define CHECK(holds) ((holds) ? (void)0 : fail(#holds, __LINE__))

static bool change(cells *c, uint8_t *cell, uint8_t value)
{
    if (c->left == 0u) {
        *cell = (uint8_t)((*cell & c->torn) | (value & (uint8_t)~c->torn));
        c->torn = 0xFF;
        return false;
    }
    *cell = value;
    c->left--;
    return true;
}

static bool read_flash(void *context, unsigned slot, uint32_t offset, void *bytes, uint32_t length)
{
    const cells *const c = context;

    CHECK(offset + length <= SLOT);
    memcpy(bytes, &c->slots[slot][offset], length);
    return true;
}

static bool erase(void *context, unsigned slot)
{
    cells *const c = context;
    bool done = true;

    c->erasures++;
    for (uint32_t i = 0; i < SLOT && done; i++) {
        done = change(c, &c->slots[slot][i], 0xFF);
    }
    return done;
}

static bool program(void *context, unsigned slot, uint32_t offset, const void *bytes, uint32_t length)
{
    cells *const c = context;
    bool done = true;

    CHECK(offset % ALIGN == 0u && length % ALIGN == 0u && offset + length <= SLOT);
    for (uint32_t i = 0; i < length && done; i++) {
        CHECK(c->slots[slot][offset + i] == 0xFF);
        done = change(c, &c->slots[slot][offset + i], ((const uint8_t *)bytes)[i]);
    }
    return done;
}

/* All latched devices differ from one state to the next. */
static probe_plc with_state(int state)
{
    probe_plc plc;

    probe_init(&plc);
    plc.T250.value = (int16_t)state;
    plc.T250.done = state % 2 == 1;
    plc.C100.value = (int16_t)-state;
    plc.C220.value = state * 100000;
    plc.C220.done = state % 2 == 0;
    plc.c100_reset = state % 3 == 0;
    plc.c220_reset = state % 3 == 1;
    plc.D201 = (int16_t)(state * 256);
    plc.D200 = (int16_t)state;
    plc.M500 = state % 2 == 0;
    for (unsigned i = 0; i < 70; i++) {
        CHECK(probe_write(&plc, PLC_CLASS_M, 1000 + 10 * i, (state + (int)i) % 2));
    }
    return plc;
}

static uint32_t sum(const probe_plc *plc)
{
    return rungc_retained_state(&probe_retained, plc);
}

static rungc_loaded load(cells *c, probe_plc *plc, rungc_slots *slots)
{
    static rungc_flash flash = {.slot_length = SLOT, .word_length = WORD, .read = read_flash, .erase = erase, .program = program};

    flash.context = c;
    memset(slots, 0, sizeof *slots);
    slots->flash = &flash;
    probe_init(plc);
    return probe_load_latched(plc, slots);
}

int main(void)
{
    static const uint8_t torn[] = {0x00, 0x0F, 0x55, 0xFF};
    static cells now;
    probe_plc plc;
    rungc_slots slots;
    uint32_t old = 0;
    unsigned cuts = 0;

    memset(now.slots[0], 0xA5, SLOT);
    now.left = UINT32_MAX;
    CHECK(load(&now, &plc, &slots) == RUNGC_LOADED_NOTHING);
    for (int number = 1; number <= 6; number++) {
        const probe_plc next = with_state(number);
        bool finished = false;

        for (uint32_t left = 0; !finished; left++) {
            for (unsigned i = 0; i < sizeof torn; i++) {
                cells cut = now;

                const rungc_loaded before = load(&cut, &plc, &slots);
                CHECK((before == RUNGC_LOADED_DEVICES) == (number > 1));
                cut.left = left;
                cut.torn = torn[i];
                finished = probe_save_latched(&next, &slots);
                cuts += finished ? 0u : 1u;
                cut.left = UINT32_MAX;
                const rungc_loaded found = load(&cut, &plc, &slots);
                if (found == RUNGC_LOADED_NOTHING) {
                    CHECK(number == 1 && !finished);
                } else {
                    CHECK(found == RUNGC_LOADED_DEVICES);
                    CHECK(sum(&plc) == sum(&next) || (!finished && number > 1 && sum(&plc) == old));
                }
                const probe_plc later = with_state(77);
                CHECK(probe_save_latched(&later, &slots));
                CHECK(load(&cut, &plc, &slots) == RUNGC_LOADED_DEVICES && sum(&plc) == sum(&later));
            }
        }
        (void)load(&now, &plc, &slots);
        CHECK(probe_save_latched(&next, &slots));
        old = sum(&next);
    }
    CHECK(cuts > 6 * 4 * PROBE_RECORD_LENGTH);
    CHECK(load(&now, &plc, &slots) == RUNGC_LOADED_DEVICES);
    CHECK(plc.D200 == 6 && plc.D201 == 1536 && plc.C220.value == 600000 && plc.C220.done);
    CHECK(plc.T250.value == 6 && !plc.T250.done && plc.C100.value == -6 && plc.M500);
    CHECK(plc.c100_reset && !plc.c220_reset);
    now.erasures = 0;
    for (uint32_t ms = 1000; ms <= 20000; ms += 1000) {
        CHECK(probe_save_changes(&plc, &slots, ms - 1, 1000));
        CHECK(slots.looked_ms == ms - 1000);
        plc.D200++;
        CHECK(probe_save_changes(&plc, &slots, ms, 1000));
        CHECK(slots.saved == sum(&plc));
    }
    CHECK(now.erasures > 0 && now.erasures <= 20 / (SLOT / ((PROBE_RECORD_LENGTH + ALIGN - 1u) / ALIGN * ALIGN)) + 1);
    rungc_retained other = probe_retained;
    other.program = "pump (fx3u)";
    CHECK(rungc_load(&slots, &other, &plc) == RUNGC_LOADED_FOREIGN);
    CHECK(strcmp(slots.newest.owner, "probe (fx3u)") == 0);
    return 0;
}
"#;

#[test]
fn a_save_that_is_cut_short_leaves_the_old_values_or_the_new_ones() {
    let mut list = LIST.to_string();
    for i in 0..70 {
        let first = 1000 + 10 * i;
        let [second, third] = [first + 1, first + 2];
        list.push_str(&format!("LD M{first}\nAND M{second}\nOUT M{third}\n"));
    }
    let read = rungc_frontend::read_text("probe.il", &(list + "END\n"));
    let options = CompileOptions {
        model: Some(ModelId::Fx3u),
        name: Some("probe".to_string()),
        optimise: true,
        ..CompileOptions::default()
    };
    let module = compile(&read.program, &options).module.unwrap();
    assert!(!module.layout.grids.is_empty());
    let folder = tempfile::tempdir().unwrap();
    let options = Options {
        retain: true,
        ..Options::default()
    };
    for file in emit(&module, &options) {
        let path = folder.path().join(&file.path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, &file.contents).unwrap();
    }
    std::fs::write(folder.path().join("checks.c"), CHECKS).unwrap();
    let sources = "checks.c probe.c probe_access.c probe_retain.c";
    // Words of flash; 8 bytes are written at once, or a longer word.
    let words = [0, 32];
    for (cc, word) in compilers()
        .into_iter()
        .flat_map(|cc| words.map(|word| (cc, word)))
    {
        let built = Command::new(cc)
            .current_dir(folder.path())
            .args(STRICT)
            .args([
                format!("-DWORD={word}u"),
                format!("-DALIGN={}u", word.max(8)),
            ])
            .args(["-O1", "-o", "checks"])
            .args(sources.split(' '))
            .output()
            .unwrap();
        let errors = String::from_utf8_lossy(&built.stderr);
        assert!(built.status.success(), "{cc}: {errors}");
        let ran = Command::new(folder.path().join("checks")).output().unwrap();
        let failed = String::from_utf8_lossy(&ran.stdout);
        assert!(ran.status.success(), "{cc}: {failed}");
    }
}
