//! The drivers of flash in images in C, on models of the controllers' registers; descriptions of boards that cannot
//! work.

use rungc_firmware::board;
use rungc_firmware::image::{self, Image, Script};
use rungc_lower::compile::{CompileOptions, compile};
use rungc_syntax::Source;
use std::path::Path;
use std::process::Command;

/// A board without pins.
const BOARD: &str = "\
name = \"Board\"
target = \"thumbv7em-none-eabihf\"

[memory]
flash = { origin = 0x0801_0000, length = \"64K\" }
ram = { origin = 0x2000_0000, length = \"64K\" }

[clock]
hz = 16_000_000
";

const F4: &str = "
[retain]
memory = \"stm32f4\"
slots = [{ origin = 0x0800_8000, length = \"16K\" }, { origin = 0x0800_C000, length = \"16K\" }]
";

const F1: &str = "
[retain]
memory = \"stm32f1\"
slots = [{ origin = 0x0800_7000, length = \"2K\" }, { origin = 0x0800_7800, length = \"2K\" }]
";

/// The controllers as ST's PM0075 and RM0090 describe them, and saves with a look at what was erased.
const MODEL: &str = r#"
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BASE 0x08000000u
#ifdef F4
enum { REGISTERS = 0x40023C00 };
#define LOCK (1u << 31)
#define START (1u << 16)
#define BUSY (1u << 16)
#define FAILED (1u << 7)
#else
enum { REGISTERS = 0x40022000 };
#define LOCK (1u << 7)
#define START (1u << 6)
#define BUSY 1u
#define FAILED (1u << 2)
#endif
#define CHECK(holds) ((holds) ? (void)0 : (printf("line %d: %s\n", __LINE__, #holds), exit(1)))

static uint8_t memory[0x20000];
static uint32_t control = LOCK, status, unlocking, page, busy;
static uint32_t erased[100], erasures;

static uint32_t read_model(uint32_t address)
{
    uint32_t word = 0;

    if (address - BASE < sizeof memory) {
        memcpy(&word, &memory[address - BASE], 4);
    } else if (address - REGISTERS == 0x0Cu) {
        word = status | (busy != 0u ? BUSY : 0u);
        busy -= busy != 0u ? 1u : 0u;
    } else if (address - REGISTERS == 0x10u) {
        word = control;
    }
    return word;
}

static void erase_model(void)
{
#ifdef F4
    const uint32_t first = (control >> 3 & 31u) * 0x4000u, length = 0x4000;
#else
    const uint32_t first = page - BASE, length = 1024;
#endif
    memset(&memory[first], 0xFF, length);
    erased[erasures++] = first;
    busy = 3;
}

static void store_model(uint32_t address, const void *bytes, uint32_t length)
{
    uint8_t *const cells = &memory[address - BASE];
    bool good = (control & 1u) != 0u && busy == 0u;

#ifdef F4
    good = good && (control >> 8 & 3u) == 2u;
#endif
    for (uint32_t i = 0; i < length; i++) {
        good = good && cells[i] == 0xFF;
    }
    if (good) {
        memcpy(cells, bytes, length);
        busy = 2;
    } else {
        status |= FAILED;
    }
}

static void write_model(uint32_t address, uint32_t value)
{
    static const uint32_t keys[] = {0x45670123u, 0xCDEF89ABu};

    switch (address - REGISTERS) {
    case 0x00:
        break;
    case 0x04:
        CHECK(value == keys[unlocking]);
        unlocking = (unlocking + 1u) % 2u;
        control &= unlocking == 0u ? ~LOCK : ~0u;
        break;
    case 0x0C:
        status &= ~value;
        break;
    case 0x10:
        if ((control & LOCK) == 0u) {
            control = value & ~START;
            if ((value & START) != 0u && (value & 2u) != 0u) {
                erase_model();
            }
        }
        break;
    case 0x14:
        page = value;
        break;
    default:
        CHECK(!"a register");
    }
}

#define READ(address) read_model(address)
#define WRITE(address, value) write_model(address, value)
#define WRITE_UNIT(address, value) store_model(address, &(value), (uint32_t)sizeof(value))

/* DRIVER */

int main(void)
{
    uint8_t bytes[64], back[64];
    uint32_t at = 0;

    for (unsigned i = 0; i < sizeof bytes; i++) {
        bytes[i] = (uint8_t)(i * 5u);
    }
    CHECK(!program_kept(NULL, 0, 0, bytes, sizeof bytes)); /* it is not erased */
    for (unsigned slot = 0; slot < 2; slot++) {
        CHECK(erase_kept(NULL, slot) && (control & LOCK) != 0u);
        for (at = 0; at < KEPT_LENGTH; at += (uint32_t)sizeof bytes) {
            CHECK(program_kept(NULL, slot, at, bytes, sizeof bytes) && (control & LOCK) != 0u);
            CHECK(read_kept(NULL, slot, at, back, sizeof back) && memcmp(bytes, back, sizeof back) == 0);
        }
    }
    for (uint32_t i = 0; i < erasures; i++) {
        printf("%X\n", (unsigned)erased[i]);
    }
    return 0;
}
"#;

fn described(text: &str) -> Result<board::Board, String> {
    let source = Source::new("board.toml", text);
    board::parse(&source, Path::new("")).map_err(|error| error.to_string())
}

/// Addresses erased by the driver in the image for a board.
fn erased(retain: &str, define: &str) -> Option<String> {
    let read = rungc_frontend::read_text("kept.il", "LD M500\nOUT M501\nEND\n");
    let options = CompileOptions {
        name: Some("kept".to_string()),
        ..CompileOptions::default()
    };
    let module = compile(&read.program, &options).module.unwrap();
    let image = Image {
        module: &module,
        board: &described(&format!("{BOARD}{retain}")).unwrap(),
        script: &Script::default(),
        modules: &[],
    };
    let files = image::c_project(&image).unwrap();
    let main = files.iter().find(|file| file.path == "main.c").unwrap();
    let from = main.contents.find("#define KEPT_LENGTH").unwrap();
    let to = main.contents.find("static const rungc_flash kept").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.c");
    std::fs::write(
        &path,
        MODEL.replace("/* DRIVER */", &main.contents[from..to]),
    )
    .unwrap();
    let program = folder.path().join("model");
    let built = Command::new("gcc")
        .args(["-std=c99", "-Wall", "-Wextra", "-Werror", define, "-o"])
        .args([&program, &path])
        .output();
    let Ok(built) = built else {
        eprintln!("not run: there is no gcc");
        return None;
    };
    let errors = String::from_utf8_lossy(&built.stderr);
    assert!(built.status.success(), "{errors}");
    let ran = Command::new(program).output().unwrap();
    let printed = String::from_utf8_lossy(&ran.stdout).trim().to_string();
    assert!(ran.status.success(), "{printed}");
    Some(printed)
}

#[test]
fn drivers_erase_and_write_flash() {
    for (retain, define, expected) in [
        (F4, "-DF4", "8000\nC000"),
        (F1, "-DF1", "7000\n7400\n7800\n7C00"),
    ] {
        if let Some(erased) = erased(retain, define) {
            assert_eq!(erased, expected);
        }
    }
}

#[test]
fn slots_that_cannot_work_are_rejected() {
    let (sectors, overlap) = ("consists of whole sectors", "the slots overlap");
    for (from, to, message) in [
        ("0x0800_C000", "0x0800_A000", overlap),
        ("\"16K\" }]", "\"8K\" }]", "both slots have the same length"),
        ("\"16K\"", "\"8K\"", sectors),
        ("0x0800_C000", "0x0801_0000", sectors),
        ("0x0800_8000", "0x2000_4000", sectors),
        ("stm32f4", "flash", "unknown name `flash`"),
    ] {
        let error = described(&format!("{BOARD}{}", F4.replace(from, to))).unwrap_err();
        assert!(error.contains(message), "{to}: {error}");
    }
    let inside = F4
        .replace("0x0800_8000", "0x0802_0000")
        .replace("0x0800_C000", "0x0804_0000");
    let inside = BOARD.replace("64K", "1M") + &inside.replace("16K", "128K");
    let error = described(&inside).unwrap_err();
    assert!(
        error.contains("is in `flash`, where the image is"),
        "{error}"
    );
    let page = F1
        .replace("2K", "1536")
        .replace("0x0800_7800", "0x0800_7C00");
    let error = described(&format!("{BOARD}{page}")).unwrap_err();
    assert!(error.contains("consists of whole pages"), "{error}");
}
