/* Flash of an RP2040: functions of its boot ROM erase and write it, and it cannot be read meanwhile. So what runs then is in RAM, and no
 * interrupt comes. */
enum { FLASH_BASE = 0x10000000, FLASH_SECTOR = 4096, FLASH_PAGE = 256, FLASH_BLOCK = 65536, ERASE_BLOCK = 0xD8 };

typedef struct {
    void (*connect)(void);
    void (*leave)(void);
    void (*erase)(uint32_t offset, uint32_t count, uint32_t block, uint8_t command);
    void (*write)(uint32_t offset, const uint8_t *bytes, uint32_t count);
    void (*flush)(void);
    void (*enter)(void);
} rom_functions;

/* The second stage of the boot ROM, in RAM: it lets flash be read again. */
static uint32_t second_stage[64];

/* A half word of the boot ROM; the compiler is not to think that nothing is at low addresses. */
static uint32_t rom_half(uint32_t address)
{
    __asm__ volatile("" : "+r"(address));
    return READ(address & ~3u) >> (8u * (address & 2u)) & 0xFFFFu;
}

/* A function of the boot ROM, by its two letters. */
static uintptr_t rom_function(char first, char second)
{
    uintptr_t (*const find)(uintptr_t table, uint32_t code) = (uintptr_t (*)(uintptr_t, uint32_t))(uintptr_t)rom_half(0x18);

    return find(rom_half(0x14), (uint32_t)first | (uint32_t)second << 8);
}

/* Erases a sector, or writes a page. */
__attribute__((section(".ram_text"), noinline)) static void change_flash(const rom_functions *rom, uint32_t offset, const uint8_t *page)
{
    rom->connect();
    rom->leave();
    if (page == NULL) {
        rom->erase(offset, FLASH_SECTOR, FLASH_BLOCK, ERASE_BLOCK);
    } else {
        rom->write(offset, page, FLASH_PAGE);
    }
    rom->flush();
    rom->enter();
}

static void rom_changes(uint32_t address, const uint8_t *page)
{
    const rom_functions rom = {
        .connect = (void (*)(void))rom_function('I', 'F'),
        .leave = (void (*)(void))rom_function('E', 'X'),
        .erase = (void (*)(uint32_t, uint32_t, uint32_t, uint8_t))rom_function('R', 'E'),
        .write = (void (*)(uint32_t, const uint8_t *, uint32_t))rom_function('R', 'P'),
        .flush = (void (*)(void))rom_function('F', 'C'),
        .enter = (void (*)(void))((uintptr_t)second_stage | 1u),
    };
    uint32_t masked;

    for (size_t i = 0; i < sizeof second_stage / sizeof second_stage[0]; i++) {
        second_stage[i] = READ(FLASH_BASE + 4u * i);
    }
    __asm__ volatile("mrs %0, primask\n\tcpsid i" : "=r"(masked)::"memory");
    change_flash(&rom, address - FLASH_BASE, page);
    __asm__ volatile("msr primask, %0" ::"r"(masked) : "memory");
}

static bool read_kept(void *context, unsigned slot, uint32_t offset, void *bytes, uint32_t length)
{
    uint8_t *const to = bytes;

    (void)context;
    for (uint32_t i = 0; i < length; i++) {
        const uint32_t at = kept_slots[slot] + offset + i;

        to[i] = (uint8_t)(READ(at & ~3u) >> (8u * (at & 3u)));
    }
    return true;
}

static bool erase_kept(void *context, unsigned slot)
{
    bool done = true;

    for (uint32_t i = 0; i < KEPT_LENGTH; i += FLASH_SECTOR) {
        rom_changes(kept_slots[slot] + i, NULL);
    }
    for (uint32_t i = 0; i < KEPT_LENGTH && done; i += 4u) {
        done = READ(kept_slots[slot] + i) == 0xFFFFFFFFu;
    }
    (void)context;
    return done;
}

/* Bytes written as erased leave the contents of a page unchanged. */
static bool program_kept(void *context, unsigned slot, uint32_t offset, const void *bytes, uint32_t length)
{
    const uint8_t *const from = bytes;
    uint8_t page[FLASH_PAGE];
    bool done = true;

    for (uint32_t i = 0; i < length && done;) {
        const uint32_t at = kept_slots[slot] + offset + i;
        const uint32_t begin = at % FLASH_PAGE;
        const uint32_t count = length - i < FLASH_PAGE - begin ? length - i : FLASH_PAGE - begin;

        memset(page, 0xFF, sizeof page);
        memcpy(&page[begin], &from[i], count);
        rom_changes(at - begin, page);
        done = read_kept(context, slot, offset + i, page, count) && memcmp(page, &from[i], count) == 0;
        i += count;
    }
    return done;
}
