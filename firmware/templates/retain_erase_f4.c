static bool erase_kept(void *context, unsigned slot)
{
    const uint32_t access = READ(FLASH_ACCESS);
    bool done = unlock_flash();

    (void)context;
    for (uint32_t sector = kept_sectors[slot].first; sector < kept_sectors[slot].end && done; sector++) {
        const uint32_t erase = 2u << 8 | 1u << 1 | sector << 3; /* PSIZE, SER, SNB */

        WRITE(FLASH_CONTROL, erase);
        WRITE(FLASH_CONTROL, erase | 1u << 16); /* STRT */
        done = flash_is_done();
    }
    WRITE(FLASH_CONTROL, FLASH_LOCK);
    if ((access & 1u << 10) != 0u) { /* DCEN: what was erased may still be in the cache */
        WRITE(FLASH_ACCESS, access & ~(1u << 10));
        WRITE(FLASH_ACCESS, (access & ~(1u << 10)) | 1u << 12); /* DCRST */
        WRITE(FLASH_ACCESS, access & ~(1u << 10));
        WRITE(FLASH_ACCESS, access);
    }
    return done;
}
