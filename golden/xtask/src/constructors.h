#ifndef RUNGC_RT_OPERANDS_H
#define RUNGC_RT_OPERANDS_H

/* Operands as programs write them: rungc_K(5), rungc_E(1.5f), rungc_D(100), rungc_U(0, 5), rungc_group(4, rungc_M(0)), rungc_bit_of(rungc_D(0), 15). */
static inline rungc_operand rungc_device(rungc_class device_class, int32_t number)
{
    rungc_operand operand;
    operand.kind = RUNGC_OPERAND_KIND_DEVICE;
    operand.class_ = device_class;
    operand.digits = 0;
    operand.area = 0;
    operand.value = number;
    return operand;
}

/* An operand whose device is in this area of the program's layout, counted from the last: rungc_in(1, rungc_D(100)). */
static inline rungc_operand rungc_in(uint8_t area, rungc_operand device)
{
    device.area = area;
    return device;
}

static inline rungc_operand rungc_K(int32_t value)
{
    rungc_operand operand = rungc_device(RUNGC_CLASS_D, value);
    operand.kind = RUNGC_OPERAND_KIND_CONST;
    return operand;
}

static inline rungc_operand rungc_E(float value)
{
    rungc_operand operand = rungc_device(RUNGC_CLASS_D, plc_float_bits(value));
    operand.kind = RUNGC_OPERAND_KIND_FLOAT;
    return operand;
}

static inline rungc_operand rungc_string(int32_t number)
{
    rungc_operand operand = rungc_device(RUNGC_CLASS_D, number);
    operand.kind = RUNGC_OPERAND_KIND_TEXT;
    return operand;
}

static inline rungc_operand rungc_group(uint8_t digits, rungc_operand first)
{
    first.kind = RUNGC_OPERAND_KIND_NIBBLES;
    first.digits = digits;
    return first;
}

static inline rungc_operand rungc_bit_of(rungc_operand word, uint8_t bit)
{
    word.kind = RUNGC_OPERAND_KIND_WORD_BIT;
    word.digits = bit;
    return word;
}

static inline rungc_operand rungc_U(uint8_t module, int32_t address)
{
    rungc_operand operand = rungc_device(RUNGC_CLASS_D, address);
    operand.kind = RUNGC_OPERAND_KIND_BUFFER;
    operand.digits = module;
    return operand;
}

static inline rungc_operand rungc_X(int32_t number)
{
    return rungc_device(RUNGC_CLASS_X, number);
}

static inline rungc_operand rungc_Y(int32_t number)
{
    return rungc_device(RUNGC_CLASS_Y, number);
}

static inline rungc_operand rungc_M(int32_t number)
{
    return rungc_device(RUNGC_CLASS_M, number);
}

static inline rungc_operand rungc_S(int32_t number)
{
    return rungc_device(RUNGC_CLASS_S, number);
}

static inline rungc_operand rungc_T(int32_t number)
{
    return rungc_device(RUNGC_CLASS_T, number);
}

static inline rungc_operand rungc_C(int32_t number)
{
    return rungc_device(RUNGC_CLASS_C, number);
}

static inline rungc_operand rungc_D(int32_t number)
{
    return rungc_device(RUNGC_CLASS_D, number);
}

static inline rungc_operand rungc_R(int32_t number)
{
    return rungc_device(RUNGC_CLASS_R, number);
}

static inline rungc_operand rungc_V(int32_t number)
{
    return rungc_device(RUNGC_CLASS_V, number);
}

static inline rungc_operand rungc_Z(int32_t number)
{
    return rungc_device(RUNGC_CLASS_Z, number);
}

static inline rungc_operand rungc_ER(int32_t number)
{
    return rungc_device(RUNGC_CLASS_ER, number);
}

/* Location of a call: the step, shown in D8069 if the instruction fails; `wide` for the 32-bit form. */
static inline rungc_site rungc_at(uint32_t step)
{
    rungc_site site;
    (void)memset(&site, 0, sizeof site);
    site.step = step;
    site.drive = true;
    return site;
}

static inline rungc_site rungc_wide_at(uint32_t step)
{
    rungc_site site = rungc_at(step);
    site.wide = true;
    return site;
}

#endif /* RUNGC_RT_OPERANDS_H */
