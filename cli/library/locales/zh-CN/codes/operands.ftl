# operand of the wrong kind
# Each operand of an instruction accepts only certain kinds of devices and constants: a contact needs a bit; a destination cannot be a constant or an input. The help lists what is accepted.
E0101 = 操作数的类型不对
    .text = 指令的每个操作数只接受某些类型的软元件和常数：触点需要位元件；目标操作数不能是常数或输入。提示列出可用的类型。

# digit count that does not fit the width
# The digit count of a group of bits (`K4M0`: four digits, 16 bits) is 1 to 4 in a 16-bit instruction and 1 to 8 in a 32-bit one; a few instructions require the full count.
E0102 = 位元件组数与数据宽度不符
    .text = 位元件组合的组数（`K4M0`：4 组，16 位）在 16 位指令中为 1～4，在 32 位指令中为 1～8；少数指令必须使用全部组数。

# index register where it is not allowed
# Contacts, coils and other basic instructions accept an index register only on FX3U, and there not with states, special relays, 32-bit counters, words and their bits. Counts, pointers and devices that the hardware binds to an instruction do not accept one either.
E0103 = 此处不允许使用变址寄存器
    .text = 触点、线圈和其他基本指令只有在 FX3U 上才能使用变址寄存器，而且不能用于状态、特殊辅助继电器、32 位计数器、字元件及其中的位。个数、指针，以及硬件规定用于某条指令的软元件，也不能使用。

# V in a 32-bit instruction
# In a 32-bit instruction, V (upper word) and Z (lower word) form a pair, which is named by Z, both as an index and as an operand.
E0104 = 32 位指令中使用了 V
    .text = 在 32 位指令中，V（高位字）和 Z（低位字）组成一对，用 Z 表示，无论作为变址还是作为操作数。

# constant outside its limits
# The operand accepts only constants from a certain range.
E0105 = 常数超出范围
    .text = 此操作数只接受一定范围内的常数。

# the model does not have this device
# The number is outside the ranges that the model has for this class. The message lists the ranges.
E0106 = 此机型没有此软元件
    .text = 编号超出此机型该类软元件的范围。消息列出了各范围。

# 32-bit counter in a 16-bit instruction
# C200 to C255 have 32 bits. A 16-bit instruction cannot use them; its 32-bit form can.
E0107 = 16 位指令使用了 32 位计数器
    .text = C200～C255 为 32 位。16 位指令不能使用它们，其 32 位形式可以。

# operand that extends past the end of its range
# The instruction uses several devices, starting with the named one (two for a 32-bit value, many for a table), and the model does not have all of them.
E0108 = 操作数超出软元件范围的末尾
    .text = 指令从指定的软元件开始占用多个软元件（32 位数据占 2 个，表占多个），而此机型没有其中的全部。

# constant that does not fit the width
# A 16-bit constant is K-32768 to K32767 or H0 to HFFFF, a 32-bit one K-2147483648 to K2147483647 or H0 to HFFFFFFFF.
E0109 = 常数超出数据宽度
    .text = 16 位常数为 K-32768～K32767 或 H0～HFFFF，32 位常数为 K-2147483648～K2147483647 或 H0～HFFFFFFFF。

# device whose number is not allowed here
# Some operands accept only certain numbers of a class: pulse outputs, interrupt inputs, groups that start at a number ending in 0.
E0110 = 此处不允许此编号的软元件
    .text = 有些操作数只接受某类软元件的一部分编号：脉冲输出，中断输入，编号个位为 0 的位元件组合。

# operands that contradict each other
# One operand limits another: a shift count must not exceed the length, both ends of a range must be of one class, two groups must have the same number of digits.
E0111 = 操作数之间相互矛盾
    .text = 一个操作数限制另一个操作数：移位的位数不能大于长度，范围的两端必须是同一类软元件，两个位元件组合的组数必须相同。

# bound of an indexed operand outside the model's devices
# `[index]` in rungc.toml says which devices an operand with an index register can reach: `D100Z0 = "D100-D163"`. These must be devices of the operand's class that the model has, all general or all special ones.
E0120 = 带变址的操作数的范围超出机型的软元件
    .text = rungc.toml 的 `[index]` 说明带变址寄存器的操作数能够访问哪些软元件：`D100Z0 = "D100-D163"`。它们必须是此机型所有的、与操作数同类的软元件，并且全部是一般软元件或全部是特殊软元件。

# operand missing
# The instruction has fewer operands than it needs. The help shows its signature.
E0301 = 缺少操作数
    .text = 指令的操作数少于所需的个数。提示给出指令的格式。

# more operands than the instruction has
# The instruction takes fewer operands. The help shows its signature.
E0302 = 操作数多于指令的规定
    .text = 指令需要的操作数没有这么多。提示给出指令的格式。
