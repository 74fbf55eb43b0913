static bool read_kept(void *context, unsigned slot, uint32_t offset, void *bytes, uint32_t length)
{
    (void)context;
    memcpy(bytes, (const void *)(uintptr_t)(kept_slots[slot] + offset), length);
    return true;
}

static bool erase_kept(void *context, unsigned slot)
{
    (void)context;
    memset((void *)(uintptr_t)kept_slots[slot], 0xFF, KEPT_LENGTH);
    return true;
}

static bool program_kept(void *context, unsigned slot, uint32_t offset, const void *bytes, uint32_t length)
{
    (void)context;
    memcpy((void *)(uintptr_t)(kept_slots[slot] + offset), bytes, length);
    return true;
}
