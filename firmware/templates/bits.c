/* Switches bits of a register, whose others stay as they are whatever interrupts. */
static void set_bits(uint32_t address, uint32_t bits, bool on)
{
    uint32_t masked;

    __asm__ volatile("mrs %0, primask\n\tcpsid i" : "=r"(masked)::"memory");
    REGISTER(address) = on ? (REGISTER(address) | bits) : (REGISTER(address) & ~bits);
    __asm__ volatile("msr primask, %0" ::"r"(masked) : "memory");
}

