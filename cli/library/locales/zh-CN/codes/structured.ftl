# this cannot be read as structured text
# A file of structured text holds `PROGRAM Name`, declarations between `VAR` and `END_VAR`, statements that end in `;`, and `END_PROGRAM`. The place is where reading stopped; what follows the next `;` is read again.
E0200 = 此处不是结构化文本
    .text = 结构化文本的文件由 `PROGRAM Name`、`VAR` 与 `END_VAR` 之间的声明、以 `;` 结束的语句和 `END_PROGRAM` 组成。标出的位置是读取停止的地方；下一个 `;` 之后的内容会继续读取。

# name that nothing declares
# A name in a statement is a label that `VAR` declares, a device (`X0`, `D10`, `D10.3`, `K4M0`), a constant (`K10`, `H1F`) or an instruction that is called.
E0201 = 没有声明的名称
    .text = 语句中的名称是 `VAR` 声明的标签、软元件（`X0`、`D10`、`D10.3`、`K4M0`）、常数（`K10`、`H1F`）或调用的指令。

# types that do not fit
# GX Works2 converts no types by itself. A condition is a BOOL; both sides of an operator and of `:=` have one type. A device D holds an INT or a WORD; for 32 bits declare a label: `Total AT D20 : DINT;`. Functions convert types: `INT_TO_DINT(x)`.
E0202 = 类型不匹配
    .text = GX Works2 不会自动转换类型。条件是 BOOL；运算符和 `:=` 两边的类型相同。软元件 D 存放 INT 或 WORD；32 位的值需要声明标签：`Total AT D20 : DINT;`。类型用函数转换：`INT_TO_DINT(x)`。

# assignment that may lose a part of the value
# A value of 32 bits does not fit in 16, and a REAL has a fraction. A conversion function says that the loss is meant: `DINT_TO_INT(x)`.
E0203 = 赋值可能丢失值的一部分
    .text = 32 位的值放不进 16 位，REAL 带有小数。转换函数表示有意舍去：`DINT_TO_INT(x)`。

# arguments that do not fit
# An instruction is called with EN, its sources, and its destinations: `MOV(EN, S, D)`. Where the manual has a number n after the destination, n stands before it: `BMOV(EN, S, n, D)`.
E0204 = 参数不匹配
    .text = 调用指令时依次写 EN、源操作数和目标操作数：`MOV(EN, S, D)`。手册中目标操作数之后的个数 n 写在它前面：`BMOV(EN, S, n, D)`。

# value that CASE lists twice
# Only the first branch with a value is ever run for it.
E0205 = CASE 中重复的值
    .text = 对一个值，只执行第一个列出它的分支。

# division by the constant 0
# The PLC reports error 6706 each time such a division runs.
E0206 = 除以常数 0
    .text = 每次执行这样的除法，PLC 都报告错误 6706。

# structured text that rungc does not compile
# rungc compiles a part of the language; the page on structured text lists it. Compile the program in GX Works2 and open its project (`.gxw`): its compiled list is read whatever the language of the source.
E0207 = rungc 不编译的结构化文本
    .text = rungc 只编译此语言的一部分，见关于结构化文本的一页。可在 GX Works2 中编译程序，再打开其工程（`.gxw`）：无论源程序用什么语言，都读取编译后的指令表。

# label that is declared twice, or named like a device or keyword
# Names that differ in case alone are equal. A label cannot have the name of a device, of a constant or of an instruction.
E0208 = 标签重复声明，或与软元件、关键字同名
    .text = 只有大小写不同的名称视为相同。标签不能与软元件、常数或指令同名。

# label for which no device is left, or whose device cannot hold it
# A label without `AT` gets a device of the range that GX Works2 reserves for labels of the model, from the top down. With `AT`, the device must suit the type: X, Y, M and S hold a BOOL, D and R a number.
E0209 = 没有软元件可分配给标签，或软元件放不下它
    .text = 没有 `AT` 的标签，从 GX Works2 为此机型的标签保留的范围中由大到小分配软元件。有 `AT` 时，软元件须适合类型：X、Y、M、S 存放 BOOL，D、R 存放数值。

# assignment to something that has no storage
# A value is assigned to a label or a device. Constants, inputs X and expressions cannot be written.
E0210 = 赋值对象不能写入
    .text = 值只能赋给标签或软元件。常数、输入 X 和表达式不能写入。

# EXIT outside of a loop
# EXIT leaves the loop around it: FOR, WHILE or REPEAT.
E0211 = EXIT 不在循环中
    .text = EXIT 离开它所在的循环：FOR、WHILE 或 REPEAT。

# value that does not exist or does not fit in its type
# An INT is -32768 to 32767, a WORD 0 to 65535, a DINT -2147483648 to 2147483647. Other bases are written `16#1F`, `2#101`, durations `T#1m30s500ms`.
E0212 = 值不存在，或超出其类型的范围
    .text = INT 为 -32768 至 32767，WORD 为 0 至 65535，DINT 为 -2147483648 至 2147483647。其他进制写作 `16#1F`、`2#101`，时间写作 `T#1m30s500ms`。

# label that nothing uses
# It takes a device and has no effect. Labels with `AT` are not reported: something outside may use the device.
W0240 = 没有使用的标签
    .text = 它占用一个软元件，但没有作用。有 `AT` 的标签不报告：程序之外可能使用其软元件。

# statements that are never run
# A condition is constant, or EXIT or RETURN stands before them.
W0241 = 从不执行的语句
    .text = 条件是常数，或者前面有 EXIT 或 RETURN。

# index register that variable indexes change
# An index of an array that is not constant is computed in Z0, and in V0 if it has 32 bits. A value that the program keeps there is lost.
W0242 = 变址寄存器被数组的变量下标改写
    .text = 数组的下标不是常数时，在 Z0 中计算，32 位的下标还使用 V0。程序保存在其中的值会丢失。

# files that are compiled as one program
# A file with a PROGRAM that uses functions, function blocks, data types or global labels of other files in its folder is compiled with these files, and with the CONFIGURATION that runs it. A file without a PROGRAM is compiled as a part of the first program that needs it. Other files of the folder are left out, and so are files with another PROGRAM, unless the CONFIGURATION names it. `[project] program` in rungc.toml lists the files of a program in place of this.
N0240 = 作为一个程序编译的多个文件
    .text = 带 PROGRAM 的文件如果使用同一文件夹中其他文件的函数、功能块、数据类型或全局标签，就与这些文件以及运行它的 CONFIGURATION 一起编译。没有 PROGRAM 的文件作为第一个需要它的程序的一部分编译。文件夹中的其他文件不参与编译；自带 PROGRAM 的文件也不参与，除非 CONFIGURATION 指名。也可以在 rungc.toml 中用 `[project] program` 列出程序的文件。

# file with another program that defines a missing name
# Programs of one folder are not mixed by accident: a file with a PROGRAM is compiled with others only if a CONFIGURATION names the program, or if rungc.toml lists both files.
N0241 = 定义了所缺名称、但自带程序的文件
    .text = 同一文件夹中的程序不会被意外混合：带 PROGRAM 的文件只有在 CONFIGURATION 指名该程序、或 rungc.toml 列出两个文件时，才与其他文件一起编译。
