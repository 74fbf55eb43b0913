# the project has no compiled program, but one is needed
# Structured text, structured ladder, function block diagrams, SFC and ladders with labels are read in the form that GX Works2 compiled them to. Nothing was compiled yet. Open the project in GX Works2, choose Compile > Rebuild All, and save it.
E0021 = 需要编译后的程序，但工程中没有
    .text = 结构化文本、结构化梯形图、功能块图、SFC 和带标签的梯形图，按 GX Works2 编译后的形式读取。此工程还没有编译。在 GX Works2 中打开工程，选择 Compile > Rebuild All（全部编译），然后保存。

# the compiled program is older than its source
# The source names devices that the compiled program in the project does not have: it was changed after the last compilation. Open the project in GX Works2, choose Compile > Rebuild All, and save it. `--compiled` reads the old program anyway.
E0022 = 编译后的程序比源程序旧
    .text = 源程序中的某些软元件，工程中编译后的程序没有：上次编译之后源程序有改动。在 GX Works2 中打开工程，选择 Compile > Rebuild All（全部编译），然后保存。`--compiled` 仍读取旧的程序。

# the ladder and the compiled program of a project differ
# GX Works2 stores the ladder as drawn and the program as last compiled. They differ, so the ladder was changed since. rungc reads the ladder; `--compiled` reads the compiled program, which the PLC may still run.
W0520 = 工程中的梯形图与编译后的程序不同
    .text = GX Works2 保存所画的梯形图和上次编译的程序。两者不同，说明之后改动过梯形图。rungc 读取梯形图；`--compiled` 读取编译后的程序，PLC 中运行的可能仍是它。

# the project's parts were found by their content
# The directory of a GX Works2 project, or a part that it lists, cannot be read. The program was found by its bytes instead: the longest undamaged one is used, which may be an older version.
W0522 = 按内容找到工程的各部分
    .text = GX Works2 工程的目录，或其中列出的某一部分，无法读取。程序是按其字节找到的：使用最长的完好的程序，它可能是较旧的版本。

# a program file that is ignored
# An FX-family PLC runs one program file. The others in the project are ignored.
W0523 = 被忽略的程序文件
    .text = FX 系列的 PLC 只运行一个程序文件。工程中的其他程序文件被忽略。

# a PLC parameter that the model does not allow
# The parameters of the project set something that the PLC model does not support. The message says what is used instead.
W0524 = 机型不允许此 PLC 参数
    .text = 工程的参数设置了此机型不支持的内容。消息说明改用什么。

# a part of the project other than its program is damaged
# Device comments, parameters, tasks, labels or structures cannot be read past some point. Everything before it is used; the program itself is not affected.
W0525 = 工程中程序以外的部分损坏
    .text = 软元件注释、参数、任务、标签或结构体从某处起无法读取。在此之前的内容全部使用；程序本身不受影响。

# a variable that is to keep its value has a device that is not latched
# The project declares the variable as RETAIN, but its device loses its value when the power fails: latched devices are those of the model and of `[latched]` in rungc.toml. Name a latched device in `[plcopen.names]`, list latched ones in `[plcopen] free`, or add the device to `[latched]`.
W0526 = 需要保持的变量使用了非停电保持的软元件
    .text = 工程把变量声明为 RETAIN，但其软元件在停电时丢失其值：停电保持的软元件由机型和 rungc.toml 的 `[latched]` 规定。在 `[plcopen.names]` 中写停电保持的软元件，在 `[plcopen] free` 中列出停电保持的软元件，或把此软元件加入 `[latched]`。

# a structured program is shown as compiled
# Structured text, structured ladder, function block diagrams, SFC and ladders with labels are read in the form that GX Works2 compiled them to, so instructions, steps and automatically assigned devices are those of the compiled program.
N0010 = 结构化程序按编译后的形式显示
    .text = 结构化文本、结构化梯形图、功能块图、SFC 和带标签的梯形图，按 GX Works2 编译后的形式读取，因此指令、步号和自动分配的软元件都是编译后程序的。

# program parts that no task runs
# Neither a task nor another POU names these POUs of the project, so they are not part of the program.
N0011 = 没有任务运行的程序部分
    .text = 工程的任务和其他程序组织单元（POU）都没有使用这些 POU，因此它们不属于程序。

# the compiled program may be older than its source
# Structured text, structured ladder, function block diagrams, SFC and ladders with labels are read in the form that GX Works2 compiled them to. Nothing in the project contradicts that this happened after the last change, but nothing proves it either: the stored times are those of the program file's creation. If the source was changed since, choose Compile > Rebuild All in GX Works2 and save. The file looks the same afterwards, so say in rungc.toml that this state of it is compiled: `[project] compiled = "…"`, with the number that the note shows. After the next change of the source, or of the compiled program, the number is another one, and the note comes back. A compiled program that contradicts its source is rejected (E0022) in any case.
N0012 = 编译后的程序可能比源程序旧
    .text = 结构化文本、结构化梯形图、功能块图、SFC 和带标签的梯形图，按 GX Works2 编译后的形式读取。工程中没有内容表明上次改动之后没有编译，但也没有内容能证明已经编译：保存的时间是程序文件的创建时间。如果之后改动过源程序，在 GX Works2 中选择 Compile > Rebuild All（全部编译）并保存。保存之后文件看起来相同，因此在 rungc.toml 中写明这一状态已经编译：`[project] compiled = "…"`，其中填写此说明所显示的编号。源程序或编译后的程序再次改动后，编号会变，说明会再次出现。与源程序矛盾的编译后程序总是被拒绝（E0022）。

# what a project holds beside its compiled program
# The numbers of programs, function blocks, functions, structures and labels of a GX Works2 project, and the languages of its sources. rungc runs the compiled program; `rungc convert --to st` writes the sources as text, for reading and for version control, and `--to labels` the labels. Devices without a comment have the names of their labels: `Start`, `Axis1.Ready`, `Main.Step` of a label of a POU.
N0013 = 工程中编译后的程序以外的内容
    .text = GX Works2 工程的程序、功能块、功能、结构体和标签的个数，以及源程序的语言。rungc 运行编译后的程序；`rungc convert --to st` 把源程序写成文本，便于阅读和版本管理，`--to labels` 写出标签。没有注释的软元件使用其标签的名称：`Start`、`Axis1.Ready`，POU 的标签为 `Main.Step`。

# the structured text of a project, compared with its compiled program
# rungc compiles the structured text of a GX Works2 project as the editor does, and looks for the same instructions in the compiled program; the numbers of automatic devices and of jumps do not matter. If the compiled program consists of these instructions, it is what its source says, and note N0012 does not appear. Other instructions are a sign that a statement was changed after the last compilation: choose Compile > Rebuild All in GX Works2 and save. They may also come from a construct that GX Works2 compiles in a way that rungc does not know. Ladders with labels, structured ladder and SFC are not compared.
N0014 = 工程的结构化文本与编译后程序的比较
    .text = rungc 像编辑软件一样编译 GX Works2 工程的结构化文本，并在编译后的程序中查找相同的指令；自动分配的软元件和跳转的编号不作区别。如果编译后的程序就是由这些指令组成的，那么它与源程序一致，不显示说明 N0012。指令不同，表明某个语句在上次编译之后改动过：在 GX Works2 中选择 Compile > Rebuild All（全部编译）并保存。也可能是 rungc 不知道 GX Works2 如何编译某种语句。带标签的梯形图、结构化梯形图和 SFC 不作比较。
