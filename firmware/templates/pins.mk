# `make` builds pins.elf for /* BOARD */.
CC = /* CC */

pins.elf: pins.c startup.c image.ld
	$(CC) -std=c11 -Wall -Wextra /* FLAGS */ -Os -ffunction-sections --specs=nano.specs -nostartfiles -T image.ld -Wl,--gc-sections,-z,noexecstack -o $@ pins.c startup.c
