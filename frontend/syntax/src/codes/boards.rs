//! Boards, and writing images into them: `rungc flash`.

super::codes! {
    BOOT_LOADER_SILENT = "E0850" "boot-loader-silent" Error None,
    "no boot loader answers",
    "`rungc flash` waits for the boot loader that the vendor of the microcontroller put into its ROM. It runs only if the pin BOOT0 is high (and BOOT1, PB2 on STM32F1, low) while the part is reset, and only on certain UARTs: USART1 (PA9, PA10) on all STM32F1 and F0. Set the jumper or switch, reset the board or switch its supply off and on, and check that TX and RX are crossed. On boards with RS-232 the line needs RS-232 levels. The boot loader measures the bit rate once after a reset: after an attempt at another `--baud`, reset again. An answer that is not one of the protocol means that a program runs instead of the boot loader, or that the bit rate is wrong.",
    wrong: "",
    right: "";

    WRONG_CHIP = "E0851" "wrong-chip" Error None,
    "the part is not known or not the expected one",
    "The boot loader reports the product number of the part (AN2606), and `rungc flash` erases only parts whose pages it knows. Boards are sold with other microcontrollers than their documents say; parts of GigaDevice and Geehy (GD32F103, APM32F030) report the numbers of the STM32 that they replace and work. Parts of HDSC and Holtek (HC32, HT32) have other boot loaders and other registers: an image for an STM32 does not run on them.",
    wrong: "",
    right: "";

    CHIP_PROTECTED = "E0852" "chip-protected" Error None,
    "the part is protected against reading or writing",
    "Firmware of vendors is usually read protected: only the vendor can restore it, and lifting the protection permanently erases all of flash, with the firmware and the PLC program in it. `rungc flash` does that only with `--unprotect`, and asks before; `--yes` alone does not allow it. If the boot loader rejects lifting the protection too, the part is locked for good (readout protection level 2 of an STM32F4 or F0), and no tool can write to it.",
    wrong: "",
    right: "";

    IMAGE_MISFIT = "E0853" "image-misfit" Error None,
    "the image does not fit the flash of the part",
    "The addresses of an image come from `memory.flash` of the board's description. They have to be within the flash of the part that answers, whose size `rungc flash` reads from the part itself. Build the image for a description with the memory of your part; if it is too large for that, `rungc build --report` shows what takes space. Nothing has been erased.",
    wrong: "",
    right: "";

    FLASHING_FAILED = "E0854" "flashing-failed" Error None,
    "the image could not be written and verified",
    "Writing was begun and did not end with flash that holds the image: the line or the supply was interrupted, the boot loader rejected a command several times, or what was read back differs. Run the same command again: it keeps what is already there and writes the rest. The first page is erased first and written last, so a part that was left in between has no program and does not switch outputs. If it fails at the same address each time, the flash is worn out or smaller than the part says; if at different ones, choose a lower `--baud` and a shorter cable.",
    wrong: "",
    right: "";

    NO_BOOT_VOLUME = "E0855" "no-boot-volume" Error None,
    "no volume of a boot loader is there",
    "The boot ROM of an RP2040 shows a volume called RPI-RP2 over USB while BOOTSEL is held when the board gets its supply, or when flash is empty. It has a file INFO_UF2.TXT that says whose it is, and `rungc flash --volume auto` looks for that file on all mounted volumes. On a system without a desktop nothing mounts it: `udisksctl mount -b /dev/sda1`, or mount it as root, and name the folder with `--volume`. A cable that only charges shows nothing. Nothing has been erased.",
    wrong: "",
    right: "";

    UNCERTAIN_PIN = "W0850" "uncertain-pin" Warning None,
    "a terminal of the program is at a pin that is not certain",
    "The description of the board marks this pin as uncertain: it comes from one published source, or its polarity or range is not published, and boards of the same name are sold with other pins. Write the pins-only image first (`rungc boards BOARD --pins-only -o pins.elf`), which reads inputs and switches one output at a time, and compare the terminals. `rungc boards BOARD --toml` writes the description, in which you correct the pin or remove `uncertain`.",
    wrong: "",
    right: "";
}
