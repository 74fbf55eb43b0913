# module that the settings do not fit
# `[[module]]` in rungc.toml lists the special modules of the PLC, and none of them has the number that the instruction names. On the PLC, FROM and TO to a number without a module are an operation error (M8067, D8067) each time they run.
W0663 = 特殊模块与设置不符
    .text = rungc.toml 的 `[[module]]` 列出了 PLC 的特殊模块，其中没有指令所指定编号的模块。在 PLC 上，对没有模块的编号执行 FROM 和 TO，每次都发生运算错误（M8067、D8067）。

# buffer memory that the module does not have
# The instruction reads or writes words after the last one of the module's buffer memory, or reserved words among them. `rungc book module-tables/index` lists the words of each module that rungc knows.
W0664 = 模块没有此缓冲存储区
    .text = 指令读出或写入的字超过了模块缓冲存储区（BFM）的最后一个字，或是其中的保留字。`rungc book module-tables/index` 列出 rungc 已知的各模块的 BFM。

# buffer memory that can only be read
# The instruction writes a word that the module itself maintains, such as a measured value or an identification code. The module ignores it.
W0665 = 缓冲存储区只能读出
    .text = 指令写入了由模块自身维护的字，如测量值或识别码。模块会忽略此写入。

# instruction that this variant of the PLC does not have
# `--model` or rungc.toml names a variant of a model, such as `h2u-mtq`, and the program uses an instruction that other PLCs of the family have and this one does not. `rungc explain h2u-mtq` lists what it lacks. Compiled programs have the instruction: name the family, `h2u`, if the program is not to run on that PLC.
E0670 = PLC 的派生机型没有此指令
    .text = `--model` 或 rungc.toml 指定了某机型的派生机型，如 `h2u-mtq`，而程序使用的指令是同系列的其他 PLC 有、此派生机型没有的。`rungc explain h2u-mtq` 列出它所缺少的内容。编译后的程序有此指令：如果程序不在该 PLC 上运行，指定系列 `h2u` 即可。

# device or pulse output that this variant of the PLC does not have
# The variant of the PLC that `--model` or rungc.toml names has fewer outputs that send pulses or give their direction, or lacks interrupts, counters or special devices that others of its family have. `rungc explain h2u-mtp` lists what it lacks.
E0671 = PLC 的派生机型没有此软元件或脉冲输出
    .text = `--model` 或 rungc.toml 指定的派生机型，其可发出脉冲或方向信号的输出较少，或缺少同系列其他 PLC 所有的中断、计数器或特殊软元件。`rungc explain h2u-mtp` 列出它所缺少的内容。

# terminal that the base unit does not have
# The program uses inputs or outputs beyond those of the base unit that `--model` or rungc.toml names. They need an extension module.
W0672 = 主模块没有此端子
    .text = 程序使用的输入或输出超出了 `--model` 或 rungc.toml 所指定的主模块。需要扩展模块。
