static bool erase_kept(void *context, unsigned slot)
{
    bool done = unlock_flash();

    (void)context;
    for (uint32_t i = 0; i < KEPT_LENGTH && done; i += KEPT_PAGE) {
        WRITE(FLASH_CONTROL, 1u << 1); /* PER */
        WRITE(FLASH_ADDRESS, kept_slots[slot] + i);
        WRITE(FLASH_CONTROL, 1u << 1 | 1u << 6); /* STRT */
        done = flash_is_done();
    }
    WRITE(FLASH_CONTROL, FLASH_LOCK);
    return done;
}
