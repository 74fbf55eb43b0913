/* The flash controller of an /* PART */: its registers and bits. */
enum {
    FLASH_ACCESS = /* BASE */,
    FLASH_KEYS = FLASH_ACCESS + 0x04,
    FLASH_STATUS = FLASH_ACCESS + 0x0C,
    FLASH_CONTROL = FLASH_ACCESS + 0x10,
    FLASH_ADDRESS = FLASH_ACCESS + 0x14
};
#define FLASH_BUSY /* BUSY */
#define FLASH_ERRORS /* ERRORS */
#define FLASH_LOCK /* LOCK */

/* Waits for the end of an operation; false if it has failed or does not end. */
static bool flash_is_done(void)
{
    uint32_t patience = 1u << 28;

    while ((READ(FLASH_STATUS) & FLASH_BUSY) != 0u && patience != 0u) {
        patience--;
    }
    return patience != 0u && (READ(FLASH_STATUS) & FLASH_ERRORS) == 0u;
}

static bool unlock_flash(void)
{
    WRITE(FLASH_STATUS, FLASH_ERRORS);
    if ((READ(FLASH_CONTROL) & FLASH_LOCK) != 0u) {
        WRITE(FLASH_KEYS, 0x45670123u);
        WRITE(FLASH_KEYS, 0xCDEF89ABu);
    }
    return flash_is_done();
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

/* ERASE */
static bool program_kept(void *context, unsigned slot, uint32_t offset, const void *bytes, uint32_t length)
{
    const uint8_t *const from = bytes;
    bool done = unlock_flash();

    (void)context;
    WRITE(FLASH_CONTROL, /* PROGRAM */);
    for (uint32_t i = 0; i < length && done; i += (uint32_t)sizeof(flash_unit)) {
        flash_unit unit;

        memcpy(&unit, &from[i], sizeof unit);
        WRITE_UNIT(kept_slots[slot] + offset + i, unit);
        done = flash_is_done();
    }
    WRITE(FLASH_CONTROL, FLASH_LOCK);
    return done;
}
