//! Ladder drawn in characters, as people write it.

use proptest::prelude::*;
use rungc_frontend::{Read, print, read_bytes};
use rungc_syntax::SourceKind;

fn read(drawing: &str) -> Read {
    let read = read_bytes("drawn.txt", drawing.as_bytes()).unwrap();
    assert_eq!(read.program.kind, SourceKind::Ladder, "{drawing}");
    read
}

/// The list of a drawing without mistakes, instructions apart by `, `.
fn list(drawing: &str) -> String {
    let read = read(drawing);
    let messages: Vec<_> = read
        .diagnostics
        .iter()
        .map(|d| (d.code, &d.message, d.span))
        .collect();
    assert!(messages.is_empty(), "{drawing}\n{messages:?}");
    let instrs = read.program.instrs.iter().map(ToString::to_string);
    instrs.collect::<Vec<_>>().join(", ")
}

/// Codes and places (line, column) of the mistakes in a drawing.
fn mistakes(drawing: &str) -> Vec<(&'static str, u32, u32)> {
    let read = read(drawing);
    let places = read.diagnostics.iter().map(|d| {
        let (line, column) = read.program.source.line_col(d.span.start);
        (d.code, line, column)
    });
    let places = places.collect();
    assert!(!read.program.is_complete());
    places
}

#[test]
fn contacts_are_written_in_many_ways() {
    let expected = "LD X000, ANI X001, OUT Y000";
    for drawing in [
        "|--[ X000 ]--[/ X001]--( Y000 )--|\n",
        "|--[ X000 ]--[ / X001 ]--( Y000 )--|\n",
        "|--[X0]--[/X1]--(Y0)--|\n",
        "|-- [ X000 ] -- [ /X001 ] -- ( Y000 ) --|\n",
        "|--|X000|--|/X001|--(Y000)--|\n",
        "|   X000   X001          |\n|---| |----|/|---(Y000)--|\n",
        "|   X000   X001\n|---] [----]/[---(Y000)--|\n",
        "|  X0   X1\n|--||---|/|--(Y0)\n",
        "│   X000    X001          │\n├───┤ ├─────┤/├───(Y000)──┤\n",
        "    X0   X1\n|---||---|/|--(Y0)\n",
        "  12 |--[ X000 ]--[/ X001]--( Y000 )--|\n",
        "--| X0 |--|/X1|--( Y0 )--\n",
        "--[ X0 ]--[/X1]--( Y0 )--\n",
        "  -[X0]-[/X1]-(Y0)-\n",
        "12 -- [ X0 ] -- [/ X1 ] -- ( Y0 )\n",
        "   X0    X1     Y0\n--| |---|/|---( )--\n",
        "    X0    X1\n---] [---]/[---(Y0)\n",
        "  X0   X1\n──┤ ├──┤/├──( Y0 )──\n",
        "  X0  X1\n--||--|/|--(Y0)--\n",
    ] {
        assert_eq!(list(drawing), expected, "{drawing}");
    }
}

#[test]
fn branches_need_no_rails() {
    let drawing = "\
; start
--[ X0 ]--+--[/X1]--+--( Y0 )--
--[ M0 ]--+         |
                    +--| X2 |--( Y1 )--
0 --[ X3 ]--[MOV K10 D0]--
LD X4
OUT Y2
";
    let expected = "LD X000, OR M0, ANI X001, OUT Y000, AND X002, OUT Y001, LD X003, MOV K10 D0";
    assert_eq!(list(drawing), format!("{expected}, LD X004, OUT Y002"));
    assert_eq!(mistakes("--[ X0 ]--[/X1]--\n"), [("E0050", 1, 17)]);
    assert_eq!(mistakes("--[ X0 --( Y0 )--\n"), [("E0051", 1, 3)]);
}

#[test]
fn lists_with_dashes_are_no_drawings() {
    for text in [
        "- [ ] test the motor\nLD X0\n",
        "- (start) - X0\n",
        "--- Motor (main) ---\n",
        "---|---|---\n",
        "-- LD X0 --\n",
        "-----\n",
        "- [link](page)\n",
    ] {
        let read = read_bytes("list.txt", text.as_bytes()).unwrap();
        assert_eq!(read.program.kind, SourceKind::Il, "{text}");
    }
}

#[test]
fn a_master_control_has_a_contact_in_the_rail() {
    let drawing = "|--[X0]--[MC N0 M100]--|\n@\n|--[X1]--(Y1)--|\n|--[MCR N0]--|\n";
    let expected = "LD X000, MC N0 M100, LD X001, OUT Y001, MCR N0";
    for bar in [
        "N0═╪═ M100",
        "  n0 ═╪═ m100 |",
        "N0=|=M100",
        "N0 ==+== M100    │",
    ] {
        assert_eq!(list(&drawing.replace('@', bar)), expected, "{bar}");
    }
    for bar in ["N0═╪═ M101", "N1═╪═ M100"] {
        assert_eq!(mistakes(&drawing.replace('@', bar)), [("E0051", 2, 1)]);
    }
    assert_eq!(mistakes("|--[X1]--(Y1)--|\n N0═╪═ M0\n"), [("E0051", 2, 2)]);
}

#[test]
fn a_note_may_hold_what_drawings_hold() {
    for note in ["(slow) [2] | a; b", "--( Y7 )--|", "a"] {
        for end in ["|", "--|", " "] {
            let read = read(&format!("|--[X0]--(Y0){end} ; {note}\n"));
            assert!(read.diagnostics.is_empty(), "{note}");
            assert_eq!(read.program.instrs[1].note(), Some(note));
        }
    }
}

#[test]
fn a_comment_may_hold_brackets() {
    let drawing = " │   X000       │\n ├───┤ ├──(Y000)┤\n │参数(N: │  (on)│\n │ (b) [  │     )│\n";
    assert_eq!(list(drawing), "LD X000, OUT Y000");
}

#[test]
fn parallel_branches_keep_their_order() {
    let drawing = "|--[X0]---------+--(Y0)--|\n|--[X1]--[X2]---+\n|--[X3]---------+\n";
    assert_eq!(
        list(drawing),
        "LD X000, LD X001, AND X002, ORB, OR X003, OUT Y000"
    );
}

#[test]
fn branches_become_blocks() {
    let drawing = "\
|--[ X000 ]--+--[/ X001]--( M0 )--|
|--[ M0 ]----+                    |
";
    assert_eq!(list(drawing), "LD X000, OR M0, ANI X001, OUT M0");
    let drawing = "\
; Two outputs, one with a contact
|--[ X0 ]--+--[ X1 ]--+--[ X3 ]--+--( Y0 )--|
|          |          |          |          |
|          +--[ X2 ]--+          +--[ T0 ]--(Y1)--|
|                                |
|                                +--( T0 K50 )-- ; half a minute
";
    let expected = "LD X000, LD X001, OR X002, ANB, AND X003, OUT Y000, MPS, AND T0, OUT Y001, MPP, OUT T0 K50";
    assert_eq!(list(drawing), expected);
    let drawing = "\
|--[ X0 ]--[ X1 ]--+--(SET M0)--|
|--[ X2 ]--[ X3 ]--+            |

|--[>= D0 K10]--[D0 < K20]--[MOV K1 D2]--|
|--[D= D0 D2]--/--(RST C0)--|
|--[END]--|
";
    let expected = "LD X000, AND X001, LD X002, AND X003, ORB, SET M0, LD>= D0 K10, AND< D0 K20, MOV K1 D2, LDD= D0 D2, INV, RST C0, END";
    assert_eq!(list(drawing), expected);
    // A label pushes its rail to the right.
    let drawing = "|--[X0]--( Y0 )--|\nP12 |--[X1]--+--( Y1 )--|\n|--[X2]------+           |\n";
    assert_eq!(
        list(drawing),
        "LD X000, OUT Y000, P12, LD X001, OR X002, OUT Y001"
    );
}

#[test]
fn labels_notes_and_lines_of_a_list_are_kept() {
    let drawing = "\
;! cpu = FX3U/FX3UC
;! X000 = start button
; Motor
P0  |--[ X000 ]--( Y000 )--|  ; main contactor
LD X1
OUT Y1
    |--[ X002 ]--[$MOV \"A ) B\" D0]--|
";
    let read = read(drawing);
    assert!(read.diagnostics.is_empty(), "{:?}", read.diagnostics);
    insta::assert_snapshot!(print::to_il(&read.program));
}

#[test]
fn mistakes_have_their_place() {
    // A wire that ends in nothing, and nothing before a contact.
    assert_eq!(
        mistakes("|--[ X0 ]--+--( Y0 )--|\n|          +--[ X1 ]---\n"),
        [("E0050", 2, 23)]
    );
    assert_eq!(
        mistakes("|--[ X0 ]--( Y0 )--|\n|     [ X1 ]--( Y1 )--|\n"),
        [("E0050", 2, 7)]
    );
    // A contact without a name, and a bracket that is open.
    assert_eq!(mistakes("|---| |---( Y0 )--|\n")[0], ("E0051", 1, 5));
    assert_eq!(mistakes("|--[ X0 ]--( Y0 --|\n")[0], ("E0051", 1, 12));
    // A bridge, a contact without effect, no output.
    let bridge = "\
|--[ X0 ]--+--[ X1 ]--+--( Y0 )--|
|          |          |          |
|          +--[ X2 ]--+          |
|--[ X3 ]-------------+--[ X5 ]--+
";
    assert_eq!(mistakes(bridge)[0].0, "E0052");
    assert_eq!(mistakes("|--[ X0 ]--[ X1 ]--|\n"), [("E0052", 1, 12)]);
    assert_eq!(
        mistakes("|--+--[ X0 ]--+--( Y0 )--|\n|  +----------+          |\n"),
        [("E0052", 1, 7)]
    );
}

/// A device with an empty comment below a drawing makes no table of comments.
#[test]
fn a_drawing_above_a_row_is_a_drawing() {
    let read = read_bytes("odd.txt", "|--[ X0 ]--( Y0 )--|\nX0;".as_bytes()).unwrap();
    assert_eq!(read.program.instrs.len(), 3);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn no_drawing_is_too_odd(lines in prop::collection::vec("[-|+ XM0-9()\\[\\]/;│├┤─┬┴→P\"]{0,40}", 0..12)) {
        let text = format!("|--[ X0 ]--( Y0 )--|\n{}", lines.join("\n"));
        let read = read_bytes("odd.txt", text.as_bytes()).unwrap();
        for diagnostic in read.diagnostics.iter() {
            prop_assert!(text.get(diagnostic.span.range()).is_some());
        }
        for instr in &read.program.instrs {
            prop_assert!(text.get(instr.span.range()).is_some());
        }
    }
}

/// Coils with their names above them, as forums draw them, some of which set and reset.
#[test]
fn coils_may_have_their_names_above() {
    let drawing = "\
|   X0      X1               Y0   |
|---] [--+--]/[-------------( )---|
|   Y0   |                        |
|---] [--+                        |
|   X2                    T0 K50  |
|---| |----------------+----( )---|
|                      |     M5   |
|                      +----(S)---|
|   T0                       M5   |
|---| |---------------------(R)---|
";
    let read = rungc_frontend::read_bytes("a.txt", drawing.as_bytes()).unwrap();
    let messages: Vec<_> = read.diagnostics.iter().map(|d| &d.message).collect();
    assert!(messages.is_empty(), "{messages:?}");
    let list: Vec<_> = read
        .program
        .instrs
        .iter()
        .map(ToString::to_string)
        .collect();
    let expected = "LD X000|OR Y000|ANI X001|OUT Y000|LD X002|OUT T0 K50|SET M005|LD T000|RST M5";
    let expected = expected.replace("M005", "M5").replace("T000", "T0");
    assert_eq!(list.join("|"), expected);
    // The name of a contact is none of a coil beside it.
    let nameless = "|   X0           |\n|---| |--( )-----|\n";
    let read = rungc_frontend::read_bytes("a.txt", nameless.as_bytes()).unwrap();
    let messages: Vec<_> = read
        .diagnostics
        .iter()
        .map(|d| d.message.as_str())
        .collect();
    assert!(messages.contains(&"a coil needs a device"), "{messages:?}");
}
