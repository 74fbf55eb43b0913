# this line cannot be read as an instruction
# A line of an instruction list has an optional step number, a mnemonic and its operands, separated by spaces. Comments start with `;` or `//`.
E0001 = 此行不是指令
    .text = 指令表的一行由可选的步号、助记符和操作数组成，以空格分隔。注释以 `;` 或 `//` 开头。

# this cannot be read as an operand
# An operand is a device (`X000`, `D10`), a device with an index register (`D0Z3`), a group of bits (`K4M0`), a bit of a word (`D0.F`), a constant (`K100`, `H1F`, `E1.5`), a text (`"ABC"`), buffer memory (`U0\G5`) or a pointer (`P4`, `I001`, `N0`).
E0002 = 不是操作数
    .text = 操作数有：软元件（`X000`、`D10`），带变址寄存器的软元件（`D0Z3`），位元件组合（`K4M0`），字元件的位（`D0.F`），常数（`K100`、`H1F`、`E1.5`），字符串（`"ABC"`），缓冲存储区（`U0\G5`），指针（`P4`、`I001`、`N0`）。

# number of an X or Y with a digit 8 or 9
# Inputs and outputs are numbered in octal: X007 is followed by X010.
E0003 = X、Y 的编号中有数字 8 或 9
    .text = 输入和输出按八进制编号：X007 之后是 X010。

# number that is too large
# No device number or constant of the PLC is this large. Floating constants also end near 0, at about 1.18E-38.
E0004 = 数值过大
    .text = PLC 没有这么大的软元件编号或常数。浮点常数在接近 0 处也有界限，约为 1.18E-38。

# text without its closing quotation mark
# A text operand starts and ends with `"` on the same line.
E0005 = 字符串缺少结束的双引号
    .text = 字符串操作数在同一行内以 `"` 开头和结尾。

# the text is not an FX instruction list
# Programs are read as instruction lists of the FX family, as structured text, as the editors' list export, or as projects of GX Developer and GX Works2. Instruction list of IEC 61131-3 is another language: its addresses (`%IX0.0`) and operators have no counterpart here. Structured text is read from files that end in `.st`, and where a text begins with `PROGRAM`.
E0006 = 文本不是 FX 指令表
    .text = 程序可以是 FX 系列的指令表、结构化文本、编程软件导出的指令表，或 GX Developer 和 GX Works2 的工程。IEC 61131-3 的指令表是另外的语言：其地址（`%IX0.0`）和运算符在这里没有对应的内容。结构化文本从扩展名为 `.st` 的文件读取，或者文本以 `PROGRAM` 开头。

# letter of another alphabet that looks Latin
# Mnemonics and devices are written with the letters A to Z. Some Cyrillic and Greek letters look the same on screen but are different characters. The line is read as it looks, so this causes no further errors.
E0007 = 看似拉丁字母的其他字母
    .text = 助记符和软元件用字母 A～Z 书写。有些西里尔字母和希腊字母在屏幕上看起来相同，却是不同的字符。此行按其外形读取，因此不会引起其他错误。

# two instructions on one line
# Each instruction of a list needs its own line; only a label may be followed by an instruction on the same line.
E0008 = 一行有两条指令
    .text = 指令表的每条指令各占一行；只有标号之后可以在同一行再写一条指令。

# text with a line break
# In an instruction list, a text ends on the line where it starts, so a text with a line break cannot be written as a list. A list export can contain it.
E0009 = 字符串中有换行
    .text = 在指令表中，字符串必须在开始的那一行结束，因此带换行的字符串不能写成指令表。导出的指令表可以包含它。

# unknown file format
# rungc reads instruction lists as text, the editors' list export (CSV), GX Developer projects (a folder or its MAIN.wpg), GX Works2 projects (.gxw), PLCopen XML and images of a PLC's program memory. It recognises the format by content, not by the file's name.
E0010 = 文件格式未知
    .text = rungc 读取文本形式的指令表、编程软件导出的指令表（CSV）、GX Developer 工程（文件夹或其中的 MAIN.wpg）、GX Works2 工程（.gxw）、PLCopen XML 和 PLC 的程序存储器映像。格式按内容识别，不按文件名识别。

# the file ends too early
# The file announces more data than it has. Everything before the end was read.
E0011 = 文件提前结束
    .text = 文件声明的数据多于实际的数据。结束之前的内容已全部读取。

# the file contradicts itself
# A length, an offset or a marker in the file contradicts the rest. The message gives the offset and the bytes.
E0012 = 文件自相矛盾
    .text = 文件中的长度、偏移或标记与其余部分矛盾。消息给出偏移和字节。

# unknown instruction code
# The project contains the code of an instruction or operand that no published table lists and no known project has shown, or whose meaning is only a guess. The message gives the bytes, the operands and the step; the help lists the instructions that would fit. The rest of the program is read. `rungc learn PROJECT EXPORT` learns instruction codes from a list that the editor exports.
E0013 = 指令编码未知
    .text = 工程中含有某条指令或操作数的编码，公开的表没有列出它，已知的工程也没有出现过，或其含义只是推测。消息给出字节、操作数和步号；提示列出可能的指令。程序的其余部分已读取。`rungc learn PROJECT EXPORT` 根据编程软件导出的指令表学习指令编码。

# row of a list export that does not fit its columns
# A row of the export lacks a column, has an operand that belongs to no instruction, or begins a text with a quote that it does not close.
E0014 = 导出的指令表中有一行与列不符
    .text = 导出的指令表中有一行缺少某一列，或其操作数不属于任何指令，或字符串以双引号开头而没有结尾。

# bytes in an unknown encoding
# Text is read as UTF-8, as UTF-16, or in the most likely code page: GBK, Big5, Shift-JIS, EUC-KR, Windows-1252 and similar. None of them fits every byte here: the file is in another encoding, or damaged. Save it as UTF-8, or name its encoding with `--encoding`.
E0015 = 字节的文字编码未知
    .text = 文本按 UTF-8、UTF-16 或最可能的代码页读取：GBK、Big5、Shift-JIS、EUC-KR、Windows-1252 等。其中没有一种适合此处的全部字节：文件使用其他文字编码，或已损坏。另存为 UTF-8，或用 `--encoding` 指定文字编码。

# the file cannot be read
# The file or folder does not exist, access is denied, or it is larger than any program. The message quotes the system.
E0016 = 文件无法读取
    .text = 文件或文件夹不存在，访问被拒绝，或文件大于任何程序。消息引用操作系统的说明。

# operand that is a label, not a device
# A source in GX Works2 may name labels, and so may a list exported from it. The editor assigns devices to them when it converts the program, and only the compiled program contains these: convert the program in the editor and save the project, or export the list of the compiled program.
E0017 = 操作数是标签，不是软元件
    .text = GX Works2 的源程序可以使用标签，从中导出的指令表也可以。编程软件在转换程序时为标签分配软元件，只有编译后的程序含有这些软元件：在编程软件中转换程序并保存工程，或导出编译后程序的指令表。

# the program is for a CPU of another family
# rungc compiles programs of the FX family. CPUs of MELSEC-Q, L, R, A and QnA and of iQ-F (FX5) have different instructions, devices and memory, even where the names are the same.
E0018 = 程序用于其他系列的 CPU
    .text = rungc 编译 FX 系列的程序。MELSEC-Q、L、R、A 和 QnA 以及 iQ-F（FX5）的 CPU，其指令、软元件和存储器都不同，即使名称相同。

# the length of an instruction in the project does not fit the instruction
# The code of an instruction in a project states its length in steps. Here it differs from the length that the instruction has with these operands, so the code may mean another instruction. Compare the step with the editor.
E0019 = 工程中指令的长度与指令不符
    .text = 工程中的指令编码给出了指令的步数。此处的步数与带这些操作数的指令的步数不同，因此编码可能表示另一条指令。把此步与编程软件对照。

# instructions read by codes that no project has shown yet
# The meaning of these codes follows from the codes around them, but no published table or known project confirms it. The message lists all of them. Compare these instructions with the editor, or let `rungc learn PROJECT EXPORT` confirm them from a list that it exports.
N0001 = 按尚未在工程中出现过的编码读取的指令
    .text = 这些编码的含义由相邻的编码推出，没有公开的表或已知的工程证实。消息列出全部编码。把这些指令与编程软件对照，或用 `rungc learn PROJECT EXPORT` 根据编程软件导出的指令表来证实。

# no model has this instruction
# The catalogue does not contain this mnemonic in any spelling. If a similar one exists, the help names it.
E0033 = 没有机型支持此指令
    .text = 指令目录中没有此助记符的任何写法。如果有相近的指令，提示会列出。

# the model does not have this instruction
# The instruction exists, but not on the model that the program is compiled for. The help lists the models that have it; `--model` selects another model.
E0034 = 此机型不支持此指令
    .text = 此指令存在，但编译程序所用的机型没有。提示列出支持的机型；用 `--model` 选择其他机型。

# the instruction does not have this form
# A mnemonic may have a 16-bit form, a 32-bit form (prefix D) and pulse forms (suffix P). Not every instruction has all of them.
E0035 = 此指令没有这种形式
    .text = 助记符可以有 16 位形式、32 位形式（前缀 D）和脉冲执行型（后缀 P）。并不是每条指令都有全部形式。

# this instruction cannot be compiled
# The instruction is known, checked and counted in steps, but nothing stands for it in a compiled program. The message says why.
E0036 = 此指令不能编译
    .text = 此指令已知，已经检查并计入步数，但编译后的程序中没有与它对应的内容。消息说明原因。

# wire of a drawn ladder that leads nowhere
# In ladder that is drawn in characters, every contact lies between the left rail and an output. A wire that ends in nothing, or a contact with nothing to its left, is most often a missing `-` or `+`, or a `|` in another column than the `+` above it. The network is left out.
E0050 = 文本梯形图中有不通的连线
    .text = 在用字符画的梯形图中，每个触点都位于左母线与输出之间。连线没有终点，或触点左侧没有连接，大多是因为缺少 `-` 或 `+`，或 `|` 与其上方的 `+` 不在同一列。此网络被略去。

# symbol of a drawn ladder that means nothing
# Contacts are `--[ X000 ]--`, `--[/ X000]--`, `--|X000|--`, or `--| |--`, `--|/|--` and `--] [--` with the device above them; comparisons `--[>= D0 K10]--`; coils `--( Y000 )--` and `--(T0 K50)--`; other instructions `--[MOV K1 D0]--` and `--(SET M0)--`.
E0051 = 文本梯形图中有无意义的符号
    .text = 触点写作 `--[ X000 ]--`、`--[/ X000]--`、`--|X000|--`，或 `--| |--`、`--|/|--` 和 `--] [--`，软元件写在上方；比较写作 `--[>= D0 K10]--`；线圈写作 `--( Y000 )--` 和 `--(T0 K50)--`；其他指令写作 `--[MOV K1 D0]--` 和 `--(SET M0)--`。

# network of a drawn ladder that no list can express
# A list has contacts in series and parallel, and branches to outputs. A wire that bridges a contact, a contact that two branches share like a bridge, or contacts without an output have no list. Draw the contact twice, or use a relay M in between.
E0052 = 文本梯形图的网络不能写成指令表
    .text = 指令表有串联和并联的触点，以及到输出的分支。跨接触点的连线，被两个分支像桥一样共用的触点，或没有输出的触点，都不能写成指令表。把触点画两次，或在中间使用辅助继电器 M。

# unknown machine code
# The program memory of a PLC contains words whose meaning no recorded transfer or published image shows. The message gives the step and the bytes, low byte first; the rest of the program is read. Extension registers R, bits of words, M3584 and above, S1024 and above, interrupt pointers, floating-point constants and texts are not known yet. Read the PLC with its editor instead, and give rungc the project.
E0060 = 机器码未知
    .text = PLC 的程序存储器中有些字，其含义没有在记录的通信或公开的映像中出现过。消息给出步号和字节，低位字节在前；程序的其余部分已读取。扩展寄存器 R、字元件的位、M3584 及以后、S1024 及以后、中断指针、浮点常数和字符串目前未知。改用编程软件读取 PLC，再把工程交给 rungc。

# instruction without known machine code
# `rungc convert --to image` writes only machine code that `rungc` reads: what recorded transfers and published images have shown, and applied instructions by their numbers. This instruction, or one of its operands, is not known; `rungc explain E0060` lists what is missing. A program must also end with END.
E0061 = 指令没有已知的机器码
    .text = `rungc convert --to image` 只写出 `rungc` 能读取的机器码：在记录的通信和公开的映像中出现过的机器码，以及按编号的应用指令。此指令或它的某个操作数未知；`rungc explain E0060` 列出未知的内容。程序还必须以 END 结束。

# the file is not the program memory of a PLC
# With `--from image`, the file is read as the program memory of an FX PLC: 92 bytes of parameters with the latched ranges from byte 30h on, then the program; a `.PMW` file of FXGP/WIN has a header of 256 bytes before them. The file does not have this form.
E0062 = 文件不是 PLC 的程序存储器
    .text = 使用 `--from image` 时，文件作为 FX PLC 的程序存储器读取：先是 92 字节的参数，从字节 30h 起为停电保持范围，然后是程序；FXGP/WIN 的 `.PMW` 文件在其前面还有 256 字节的文件头。此文件不是这种形式。

# element of a PLCopen project without a counterpart
# Of PLCopen XML, rungc reads programs as LD, FBD, IL and SFC, with contacts, coils and those functions and blocks of IEC 61131-3 that instructions of the PLC compute exactly. The message names the element, its line and what is different: structured text, blocks of the project's own, types such as REAL, actions that do not end with their step, a comparison with EN, a timer whose preset is not a constant. So are tasks that one scan cannot replace: those that wait for an event, or have different intervals.
E0063 = PLCopen 工程中有没有对应内容的元素
    .text = 对于 PLCopen XML，rungc 读取 LD、FBD、IL 和 SFC 程序，包括触点、线圈，以及 IEC 61131-3 中 PLC 的指令能够精确计算的功能和功能块。消息给出元素、所在的行和不同之处：结构化文本，工程自定的功能块，REAL 等类型，不随 SFC 的步结束的动作，带 EN 的比较，设定值不是常数的定时器。不能用一次扫描代替的任务也是如此：等待事件的任务，或周期不同的任务。

# variable of a PLCopen project without a device
# A PLC of the FX family knows devices, not variables. A variable of a PLCopen project becomes the device that `[plcopen.names]` of `rungc.toml` or a table for `--names` names, or the device at its address: `%IX0.3` is X003, `%QX1.0` is Y010, `%MX0.5` is M5, `%MW7` is D7 (bits are counted through, eight to a byte). A variable with neither must have the name of a device, such as `M100`, or `[plcopen]` must list free devices. No two variables of a program have the same name; upper and lower case are the same.
E0064 = PLCopen 工程中有没有软元件的变量
    .text = FX 系列的 PLC 只有软元件，没有变量。PLCopen 工程的变量对应于 `rungc.toml` 的 `[plcopen.names]` 或 `--names` 的表所指定的软元件，或其地址处的软元件：`%IX0.3` 为 X003，`%QX1.0` 为 Y010，`%MX0.5` 为 M5，`%MW7` 为 D7（位连续编号，每字节 8 个）。两者都没有的变量，其名称必须是软元件的名称，如 `M100`，否则 `[plcopen]` 必须列出空闲的软元件。一个程序中不能有同名的两个变量；不区分大小写。

# PLCopen project that is not well-formed XML
# The file begins like a PLCopen project, but its XML is damaged. The message gives the place. Export the project again.
E0065 = PLCopen 工程的 XML 格式不正确
    .text = 文件的开头像 PLCopen 工程，但其 XML 已损坏。消息给出位置。重新导出工程。

# call of a subroutine that no window is called
# In a list of AutoShop, `CALL` names a subroutine, whose list follows the heading `SBR` with the same name. Without the heading, nothing says where the subroutine is.
E0066 = 没有此名称的子程序
    .text = 在 AutoShop 的指令表中，`CALL` 写子程序的名称，其指令表位于同名的标题 `SBR` 之后。没有此标题，就无法得知子程序的位置。

# heading of a window that names none
# A list of AutoShop consists of windows: the main program after the heading `MAIN`, which may be left out, then each subroutine after `SBR` and its name, and each interrupt routine after `INT`, its name and its interrupt pointer. Names are single words, and no two windows have the same one. A subroutine's heading may state its pointer: `SBR 加料 P1`.
E0067 = 程序块的标题没有名称
    .text = AutoShop 的指令表由程序块组成：标题 `MAIN` 之后的主程序（标题可以省略），然后是 `SBR` 和名称之后的各个子程序，以及 `INT`、名称和中断指针之后的各个中断程序。名称是一个单词，两个程序块不能同名。子程序的标题可以写出其指针：`SBR 加料 P1`。

# program that AutoShop's windows cannot hold
# `rungc convert --to autoshop` divides a program into the windows of AutoShop: the main program up to FEND, subroutines from their label to SRET, interrupt routines from their pointer to IRET. A second FEND, labels between routines, a subroutine with several labels and calls of `P0Z0`, whose target the program computes, do not fit: names take the place of pointers there.
E0068 = AutoShop 的程序块不能容纳此程序
    .text = `rungc convert --to autoshop` 把程序分成 AutoShop 的程序块：到 FEND 为止的主程序，从标号到 SRET 的子程序，从指针到 IRET 的中断程序。第二个 FEND，子程序之间的标号，有多个标号的子程序，以及由程序计算目标的调用 `P0Z0`，都不能写入：在程序块中，名称代替了指针。

# network that cannot be drawn as PLCopen XML
# `rungc convert --to plcopen` writes a program as its networks of contacts and outputs. This network is a list without such a structure, for example because a block is joined that was never started, more contacts lead to one output than rungc reads back, 2,000, or one of its instructions would read back as another one, so nothing is written. `--to il` and `--to csv` write such programs.
E0740 = 网络不能画成 PLCopen XML
    .text = `rungc convert --to plcopen` 把程序按由触点和输出组成的网络写出。此网络是没有这种结构的指令表，例如连接了从未开始的回路块，通向一个输出的触点多于 rungc 能读回的 2000 个，或其中某条指令会读回为另一条指令，因此什么也没有写出。`--to il` 和 `--to csv` 可以写出这样的程序。

# instructions without a counterpart in IEC 61131-3
# In the project that `rungc convert --to plcopen` writes, these instructions are blocks whose types begin with `FX_`, with the operands `p1`, `p2` and so on, and in a list functions that are called so. rungc reads them back; other editors show them but do not know what they do.
N0740 = IEC 61131-3 中没有对应内容的指令
    .text = 在 `rungc convert --to plcopen` 写出的工程中，这些指令写成类型名以 `FX_` 开头的功能块，操作数为 `p1`、`p2` 等；在指令表中写成同名的功能。rungc 可以读回它们；其他编程软件能显示它们，但不知道其作用。

# PLCopen project that reads back as another list
# Several lists have the same drawing: contacts may be joined by ANB without need, a stack may hold what no branch needs, and INV after a single contact makes it the opposite one (`LD X0`, `INV` is `LDI X0`). The project that `rungc convert --to plcopen` writes reads back as another list that does the same; the message says what becomes of the instructions here.
N0741 = PLCopen 工程读回为不同的指令表
    .text = 多种指令表可以有相同的图：不必要的 ANB，堆栈中存放了没有分支需要的结果，单个触点之后的 INV 使其成为相反的触点（`LD X0`、`INV` 即 `LDI X0`）。`rungc convert --to plcopen` 写出的工程读回为作用相同的另一种指令表；消息说明此处的指令会变成什么。

# step ladder that no chart can express
# `rungc convert --to plcopen --body sfc` writes states as the steps of a sequential function chart. A step begins by a transition after other steps or, if it is initial, in the first scan (M8002); it ends by a transition. States that other instructions set or reset (SET, RST and ZRST outside of the states, RST in a state), states that networks outside read, and jumps, calls and loops in a state cannot be said so. `--body ld` and `--body il` write such programs.
E0741 = 步进梯形图不能写成顺序功能图
    .text = `rungc convert --to plcopen --body sfc` 把状态写成顺序功能图（SFC）的步。SFC 的步由其他步之后的转移开始，初始步在第一次扫描（M8002）开始；它由转移结束。由其他指令置位或复位的状态（状态之外的 SET、RST 和 ZRST，状态之中的 RST），由外部的网络读取的状态，以及状态中的跳转、调用和循环，都不能这样表示。`--body ld` 和 `--body il` 可以写出这样的程序。

# chart that switches by the rules of IEC 61131-3
# The steps of a chart do not switch exactly as states do. In a chart, all transitions are evaluated first, then steps end, then others begin, and the actions of the active steps are executed last. STL executes a state before it leaves it, begins the next one at once, and lets both overlap for a scan. Of several transitions after a step, a chart takes the first whose condition holds; STL takes all of them. Outputs can therefore differ by a scan, and what a state stores (SET, MOV) under the condition by which it ends, a chart does not store.
N0742 = 按 IEC 61131-3 的规则切换的顺序功能图
    .text = 顺序功能图中步的切换与状态的切换不完全相同。在顺序功能图中，先判断全部转移，然后结束旧的步，再开始新的步，最后执行活动步的动作。STL 先执行一个状态再离开它，立即开始下一个状态，并使两者重叠一次扫描。一个步之后有多个转移时，顺序功能图只取第一个条件成立的转移，STL 则全部执行。因此输出可能相差一次扫描；状态在其结束条件下存放的结果（SET、MOV），顺序功能图不会存放。

# the project is protected
# The PLC parameters of the project hold a keyword, with which its author keeps others from reading the program. rungc respects that. The author can delete the keyword in the editor and save the project again.
E0650 = 工程受密码保护
    .text = 工程的 PLC 参数中设有密码（关键字），作者用它防止他人读取程序。rungc 尊重这一点。作者可以在编程软件中删除密码，然后重新保存工程。
