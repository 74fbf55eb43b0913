# relays that are driven and never read
# Nothing in the program reads these relays, states, timers or counters. That is fine if an operator panel does; otherwise they are leftovers or misspelt.
W0201 = 被驱动但从未读取的继电器
    .text = 程序中没有任何指令读取这些继电器、状态、定时器或计数器。如果由触摸屏读取，可以忽略；否则它们是遗留的，或写错了编号。

# contacts of relays, or values of registers, that nothing writes
# Nothing in the program drives these relays, states, timers or counters, so their contacts never change; nothing writes these registers, so what compares them or takes them as a preset finds 0. RST, ZRST and writing 0 switch nothing on, so they do not count. An operator panel may write them: name what it writes in rungc.toml, `[hmi] writes = ["M100-M115", "D0-D9"]`. Latched registers, which keep what was once written, are not reported, nor are registers of a program whose ports let others write.
W0202 = 从未写入的继电器触点或寄存器值
    .text = 程序中没有任何指令驱动这些继电器、状态、定时器或计数器，因此其触点从不变化；没有任何指令写入这些寄存器，因此用它们比较或作为设定值时，值总是 0。RST、ZRST 和写入 0 不会使任何软元件接通，因此不算在内。它们可能由触摸屏写入：在 rungc.toml 中写出触摸屏写入的软元件，`[hmi] writes = ["M100-M115", "D0-D9"]`。停电保持的寄存器保留以前写入的值，因此不报告；端口允许外部写入的程序，其寄存器也不报告。

# coil driven in two places
# Whenever the first rung writes the coil, a later one of the same scan writes it again, so the last one decides its state; the result of the first is lost. The later one may also be an instruction that writes the coil as part of a word. Pulses and a coil disturb each other on one output. Join the conditions with OR, or use SET and RST. In different states of a step ladder, or in subroutines that are not both called, a coil may be driven again.
W0203 = 双线圈
    .text = 每当前面的网络写入此线圈，同一次扫描中后面的网络又写入一次，因此由最后一次决定线圈的状态，前面的结果丢失。后面的也可以是把线圈作为字的一部分写入的指令。同一输出上的脉冲和线圈会互相干扰。用 OR 把各条件合并，或改用 SET 和 RST。在步进梯形图的不同状态中，或在不会同时被调用的子程序中，线圈可以再次驱动。

# timer or counter driven in two places
# A timer driven in two places starts and clears according to whichever runs; a counter counts the changes of both. Use a separate one in each place.
W0204 = 定时器或计数器在两处驱动
    .text = 在两处驱动的定时器，按执行到的那一处开始计时和清零；计数器则把两处的变化都计入。每处使用单独的一个。

# timer used in a state and in the one that follows it
# At the transition both states are on for one scan, so the coil of the timer does not turn off and the timer is not cleared.
W0205 = 定时器用于相邻的两个状态
    .text = 转移时两个状态在一次扫描中同时为 ON，因此定时器的线圈没有断开，定时器没有清零。

# 32-bit values that share a word
# A 32-bit value occupies the named register and the next one. Two values that start at adjacent registers overwrite each other.
W0206 = 32 位数据共用一个字
    .text = 32 位数据占用指定的寄存器和下一个寄存器。从相邻的寄存器开始的两个数据会互相覆盖。

# write to a special device that the system maintains
# The system writes this special relay or register itself; what the program writes has no lasting effect. Some devices of serial ports are the program's in one role of the port, such as D8415 of a Modbus slave on FX3; elsewhere they are the system's.
W0208 = 写入了由系统维护的特殊软元件
    .text = 系统自行写入此特殊辅助继电器或特殊数据寄存器；程序写入的值不会保留。串口的某些软元件在端口的某一种角色下由程序写入，如 FX3 上 Modbus 从站的 D8415；其他情况下由系统写入。

# label that nothing jumps to or calls
# The label can be removed, or a jump or call is missing.
W0209 = 没有被跳转或调用的标号
    .text = 可以删除此标号，也可能是缺少跳转或调用。

# instructions that never run
# After FEND, SRET or IRET, only a label can be reached; these instructions precede the next one.
W0210 = 执行不到的指令
    .text = FEND、SRET 或 IRET 之后，只有标号能够到达；这些指令位于下一个标号之前。

# instructions after END
# The scan ends at the first END; instructions after it never run.
W0211 = END 之后有指令
    .text = 扫描在第一个 END 处结束；其后的指令从不执行。

# interrupt routines or pulse catch without EI
# Interrupts are disabled at the start of RUN; without EI these routines never run, and the relays of pulse catch (from M8170) stay off.
W0212 = 有中断程序或脉冲捕捉，但没有 EI
    .text = RUN 开始时中断处于禁止状态；没有 EI，这些中断程序从不执行，脉冲捕捉的继电器（M8170 起）保持 OFF。

# ordinary timer in a subroutine or interrupt routine
# An ordinary timer is updated where its coil is executed; in a routine that does not run in every scan, it measures incorrectly. A subroutine that is called in every scan while the timer is needed is fine. T192 to T199 (100 ms) and T246 to T249 (1 ms, until RST) are intended for routines: they continue in scans that do not execute their coils. FX1S, FX3S and HM have none of them.
W0213 = 子程序或中断程序中使用了普通定时器
    .text = 普通定时器在执行其线圈时更新；在不是每次扫描都执行的子程序或中断程序中，计时不准。如果在需要定时器期间每次扫描都调用此子程序，则没有问题。T192～T199（100 ms）和 T246～T249（1 ms，直到 RST）供子程序和中断程序使用：在不执行其线圈的扫描中，它们继续计时。FX1S、FX3S 和 HM 没有这些定时器。

# jump into, out of or between states
# A jump that leaves its state skips the handling of transitions. The manual discourages it: use a transition.
W0214 = 跳入、跳出状态或在状态之间跳转
    .text = 从状态中跳出会略过转移的处理。手册不建议这样做：改用转移。

# subroutine that calls itself
# A subroutine must not call itself, directly or through others. The PLC accepts the program, but skips the recursive call with error 6702 when it is reached.
W0215 = 子程序调用自身
    .text = 子程序不得直接或间接地调用自身。PLC 接受这样的程序，但执行到递归调用时将其跳过，错误代码为 6702。

# fast input with two purposes
# Use each fast input for one purpose only: SPD, the signals of ZRN, DSZR and DVIT, a high-speed counter, an input interrupt or pulse catch.
W0216 = 快速输入有两种用途
    .text = 每个快速输入只用于一种用途：SPD，ZRN、DSZR 和 DVIT 的信号，高速计数器，输入中断或脉冲捕捉。

# more fast inputs and outputs than the hardware supports
# Fast inputs and outputs of H1U and H2U share 56 units of hardware: a pulse output takes 7, a counter with one input 6, with two inputs 13, for an encoder 17, SPD 4, an input interrupt or pulse catch 1.
W0217 = 快速输入和输出超过硬件的限制
    .text = H1U 和 H2U 的快速输入和输出共用 56 个单位的硬件资源：脉冲输出占 7 个，单输入计数器占 6 个，双输入计数器占 13 个，用于编码器占 17 个，SPD 占 4 个，输入中断或脉冲捕捉占 1 个。

# part of a result that is also written separately
# The result of a 32-bit instruction takes two registers, as does the product of MUL; DIV stores the remainder after the quotient; the 32-bit forms of both take four. An instruction that writes one of the later registers overwrites a part of the result. Registers that are only cleared are not reported, nor are values whose low word is also written separately, since they are assembled from words.
W0220 = 运算结果的一部分又被单独写入
    .text = 32 位指令的结果占 2 个寄存器，MUL 的积也是；DIV 把余数存放在商之后；两者的 32 位形式占 4 个。写入其中后面的寄存器的指令会覆盖结果的一部分。只清零的寄存器不报告；低位字也被单独写入的数据不报告，因为它们是由各个字组成的。

# coil that both OUT and SET or RST write
# OUT writes its coil in every scan, whether its contacts are closed or not, so it undoes a SET at once, and a RST before it too. A RST after the OUT, which forces the coil off for the rest of the scan, is not reported; neither are a SET and an OUT in different states. An instruction that writes the coil in every scan as part of a word, as `MOV D0 K2Y0` under M8000, undoes a SET or RST before it likewise.
W0221 = 同一线圈既用 OUT，又用 SET 或 RST
    .text = 无论触点是否接通，OUT 每次扫描都写入线圈，因此会立即取消前面的 SET，也会取消前面的 RST。OUT 之后的 RST 使线圈在本次扫描的其余时间断开，不报告；位于不同状态的 SET 和 OUT 也不报告。每次扫描都把线圈作为字的一部分写入的指令，如 M8000 驱动的 `MOV D0 K2Y0`，同样会取消前面的 SET 或 RST。

# state that occurs twice
# Each state of a step ladder has one section, which starts with its STL. A second section with the same number is usually a copy whose number was not changed: while the state is on, both run. Consecutive STL that join parallel branches repeat their states and are not reported.
W0222 = 状态重复出现
    .text = 步进梯形图的每个状态只有一段程序，从其 STL 开始。编号相同的第二段通常是复制后没有改编号：状态为 ON 时，两段都执行。用于汇合并行分支的连续 STL 会重复其状态，不报告。

# ZRST whose first device comes after its last
# ZRST resets from its first device up to its second. If the first has the higher number, only that one is reset. On H1U, H2U and HM this is an error.
W0223 = ZRST 的首软元件位于末软元件之后
    .text = ZRST 复位从第一个软元件到第二个软元件的范围。如果第一个的编号更大，则只复位它一个。在 H1U、H2U 和 HM 上，这是错误。

# division by the constant 0
# Each time the instruction runs, the PLC reports an operation error in M8067 and D8067 and leaves the result unchanged. On HM, DIV gives the limit of the range instead.
W0224 = 除数为常数 0
    .text = 每次执行此指令，PLC 都在 M8067 和 D8067 中报告运算错误，结果保持不变。在 HM 上，DIV 的结果为范围的极限值。

# instruction that changes its own operand in every scan
# An instruction without the suffix P runs in each scan in which its contacts are closed: INC counts scans, ALT flickers, a shift empties its register, and a result that replaces one of its sources (ADD D0 K5 D0) is computed again. An input or a one-second clock stays on for many scans. Use the pulse form or LDP. Only instructions driven by inputs and clocks alone are reported, outside loops, routines, states and code that jumps skip.
W0225 = 每次扫描都改变自身操作数的指令
    .text = 没有后缀 P 的指令在触点接通期间每次扫描都执行：INC 变成对扫描计数，ALT 不停翻转，移位会把寄存器移空，以源操作数之一存放结果的运算（ADD D0 K5 D0）反复计算。输入或 1 秒时钟会连续接通许多次扫描。使用脉冲执行型或 LDP。只报告仅由输入和时钟驱动、并且不在循环、子程序、中断程序、状态和被跳过的程序段中的指令。

# counter or accumulating timer that nothing resets
# A 16-bit counter that has reached its preset stops counting, and its contact stays closed until RST clears it. An accumulating (retentive) timer (T246 to T255 on most models, T128 to T137 on FX3S) keeps its value when its coil turns off, so its contact stays closed likewise. Nothing in the program resets them.
W0226 = 没有复位的计数器或累计型定时器
    .text = 16 位计数器达到设定值后停止计数，其触点保持接通，直到用 RST 清零。累计型定时器（多数机型为 T246～T255，FX3S 为 T128～T137）在线圈断开时保留当前值，因此其触点同样保持接通。程序中没有任何指令复位它们。

# output that is set and never reset
# SET turns an output on until something resets it. Nothing in the program does, so it stays on until STOP.
W0227 = 置位后从未复位的输出
    .text = SET 使输出接通，直到有指令复位它。程序中没有这样的指令，因此输出一直接通到 STOP。

# instructions that an unconditional jump skips
# M8000 is on in every scan, so the jump is always taken and the instructions before its label never run.
W0228 = 被无条件跳转跳过的指令
    .text = M8000 每次扫描都为 ON，因此总是跳转，标号之前的指令从不执行。

# output of pulses with two purposes at the same time
# An output gives pulses or their direction, not both. It sends the pulses of one instruction at a time. Two instructions that are driven by the same contacts, or one of which is always driven, interfere with each other: the second does not start, or not before the first has ended. On HM, the same holds for two motions of one axis, to which only IPL adds pulses, and for PTAB, PCTAB and PBTAB, of which one runs at a time.
W0229 = 脉冲输出同时有两种用途
    .text = 一个输出要么发出脉冲，要么给出方向，不能两者兼有，并且同一时间只发出一条指令的脉冲。由相同触点驱动的两条指令，或其中一条始终被驱动的两条指令，会互相干扰：第二条不启动，或要等第一条结束后才启动。在 HM 上，同一轴的两个运动也是如此，只有 IPL 能向其插入脉冲；PTAB、PCTAB 和 PBTAB 也是如此，同一时间只能运行其中一个。

# more branches of a step ladder than the PLC supports
# A state branches into at most 8 others, selective or parallel, and at most 16 circuits branch off in the flow of one initial state. The editors do not show such a flow, and the manuals do not say how the PLC runs it. Compiled programs have no such limit.
W0230 = 步进梯形图的分支超过 PLC 的限制
    .text = 一个状态最多分支到 8 个其他状态（选择分支或并行分支），一个初始状态的流程中最多有 16 条分支回路。编程软件不能显示这样的流程，手册也没有说明 PLC 如何运行它。编译后的程序没有此限制。

# backward jump that is always taken
# The jump has no condition that could be off, and nothing between the label and the jump leaves the loop: the scan does not end, and the watchdog stops the PLC.
W0231 = 总是执行的跳回
    .text = 此跳转没有可能断开的条件，标号与跳转之间也没有离开循环的途径：扫描不会结束，监视定时器（看门狗）将停止 PLC。

# table of ABSD in bits that do not start at a multiple of 8
# The manual of H1U and H2U demands that the bits of ABSD's table start at a multiple of 8 (h1u-h2u-programming §4.3.7); whether that holds for the 16-bit form, too, its wording leaves open. DABSD rejects such a table.
W0232 = ABSD 的表所用的位元件没有从 8 的倍数开始
    .text = H1U 和 H2U 的手册要求 ABSD 表的位元件从 8 的倍数开始（h1u-h2u-programming 4.3.7 节）；16 位形式是否也有此要求，手册的文字没有说清。DABSD 不接受这样的表。

# high-speed counter without inputs
# The table of high-speed counters in the manual gives this counter no inputs. It never counts.
W0233 = 没有输入的高速计数器
    .text = 手册的高速计数器表中，此计数器没有输入。它从不计数。

# constant with which the instruction always fails
# The instruction does not accept this constant. Each time it runs, the PLC reports an operation error in M8067 and D8067, on HM in M8006 and D8006, and leaves the result unchanged. Motions of HM do not start: they end with an error (64) in the state of their axis, or of their table. JOG without inputs never moves.
W0234 = 指令使用此常数总是失败
    .text = 指令不接受此常数。每次执行时，PLC 都在 M8067 和 D8067 中报告运算错误（HM 为 M8006 和 D8006），结果保持不变。HM 的运动不会启动：它以错误（64）结束，记录在轴或表的状态中。没有输入的 JOG 从不运动。

# 32-bit counter with an index on HM
# On HM, an index counts 16-bit words. With the index 1, `C200V0` is therefore not C201 but the high word of C200 and the low word of C201, and the index 2 leads to C201. The manual advises against such operands (hm-motion-controller §5.1.8). Copy the counters to data registers and index these: `DMOV C200 D1000`, `DMOV C201 D1002`, then D1000 with an index of 0 or 2.
W0235 = HM 上带变址的 32 位计数器
    .text = 在 HM 上，变址按 16 位字计算。因此变址为 1 时，`C200V0` 不是 C201，而是 C200 的高位字和 C201 的低位字；变址为 2 时才是 C201。手册不建议使用这样的操作数（hm-motion-controller 5.1.8 节）。把计数器复制到数据寄存器，再对数据寄存器变址：`DMOV C200 D1000`、`DMOV C201 D1002`，然后用变址 0 或 2 访问 D1000。

# motion that is driven for one scan
# Pulse outputs and motions run while their contacts are closed, and stop when they open. An edge (LDP, PLS, MEP) and M8002 close them for one scan: the motion starts, and stops in the next scan. Let the edge SET a relay that drives the motion, and RST it at the end: M8029, or on HM 32 in the state of the axis (D320, D370, …) or of the table. Only IPL of HM is meant for edges, too. Routines, loops and code that jumps skip are not reported.
W0236 = 只被驱动一次扫描的运动
    .text = 脉冲输出和运动在触点接通期间运行，触点断开时停止。上升沿（LDP、PLS、MEP）和 M8002 只接通一次扫描：运动启动，下一次扫描就停止。让上升沿用 SET 置位一个继电器来驱动运动，结束时用 RST 复位：结束信号为 M8029，在 HM 上为轴状态（D320、D370 等）或表状态中的 32。只有 HM 的 IPL 也可以用上升沿驱动。子程序、中断程序、循环和被跳过的程序段不报告。

# value of a high-speed counter that nothing drives
# A high-speed counter counts its inputs while its coil is driven. Without `OUT` its value never changes, and comparisons such as HSCS never act. A counter into which the program writes values is a register, and is not reported.
W0237 = 没有驱动的高速计数器的值
    .text = 高速计数器在线圈被驱动期间才对输入计数。没有 `OUT`，其值从不变化，HSCS 等比较从不动作。由程序写入值的计数器作为寄存器使用，不报告。

# write to a register that the system of HM uses
# The manual of HM keeps D0 to D79, D98 to D199 and D600 to D999 for the system, and some registers of each output axis between D300 and D599 (hm-motion-controller §5.1, §8.2.3). On the PLC, the program and the system overwrite each other's values there. Registers from D1000 on are free. Runs of more than 32 registers are not reported.
W0238 = 写入了 HM 系统使用的寄存器
    .text = HM 的手册把 D0～D79、D98～D199 和 D600～D999 留给系统，另外 D300～D599 中有一部分寄存器属于各输出轴（hm-motion-controller 5.1 节、8.2.3 节）。在 PLC 上，程序和系统会在这里互相覆盖对方的值。D1000 及以后的寄存器可以自由使用。一次写入超过 32 个寄存器的情况不报告。

# two comparisons of high-speed counters in one compare zone
# DHSCS, DHSCR and DHSZ of HM share the compare zones 0 to 5, and a zone executes one instruction at a time (hm-motion-controller §8.3.14). Two that are driven by the same contacts, or one of which is always driven, need a zone each. Compiled code runs both.
W0239 = 同一比较区有两条高速计数器比较指令
    .text = HM 的 DHSCS、DHSCR 和 DHSZ 共用比较区 0～5，一个比较区同一时间只执行一条指令（hm-motion-controller 8.3.14 节）。由相同触点驱动的两条指令，或其中一条始终被驱动的两条指令，须各用一个比较区。编译后的程序两条都执行。

# interrupt routine that can never run
# Nothing requests the routine, or nothing allows it. On HM, D211 selects the edges of X004 and X005 that interrupt, D261 those of X006 and X007; both are H00 at power-on, with which X005 and X007 do not interrupt (hm-motion-controller §5.5.6). The masks of HM's timer interrupts, M8056 to M8058, are on at power-on; I001, I201, I020 to I050 and I900 to I907 are requested by relays that the program sets. I010 to I060 of other models need a comparison such as DHSCS that names them, the ends of pulses (I502 to I506) and the rows of a table of counts of H1U and H2U a relay that allows them. A routine that the program requests by its relay is not reported, nor is one whose relay or register something outside the program writes (`[hmi] writes`).
W0250 = 永远不会执行的中断程序
    .text = 没有任何东西请求此中断程序，或没有任何东西允许它执行。在 HM 上，D211 选择 X004 和 X005 的哪些边沿进入中断，D261 选择 X006 和 X007 的；两者上电时都是 H00，此时 X005 和 X007 不进入中断（hm-motion-controller 5.5.6 节）。HM 定时中断的禁止标志 M8056～M8058 上电时为 ON；I001、I201、I020～I050 和 I900～I907 由程序置位的继电器请求。其他机型的 I010～I060 需要一条以其为目标的比较指令，如 DHSCS；H1U 和 H2U 的脉冲结束中断（I502～I506）和计数表各行的中断需要允许它们的继电器。程序通过继电器请求的中断程序不报告；其继电器或寄存器由程序之外写入的（`[hmi] writes`）也不报告。

# special device that has no effect in a compiled program
# On the PLC, this special relay or register configures or reports something: a CAN network, a special module that rungc.toml does not list, the delay of an interrupt. Compiled programs do not have that function, so it is an ordinary relay or register there. The help page of each model (`rungc book special-devices/index`) and `rungc explain D8393` show which devices work. Devices that only report faults that cannot happen here (a low battery, a failed supply) are not reported.
W0301 = 编译后的程序中不起作用的特殊软元件
    .text = 在 PLC 上，此特殊辅助继电器或特殊数据寄存器用于设置或报告某项功能：CAN 网络，rungc.toml 没有列出的特殊模块，中断的延时。编译后的程序没有该功能，因此它在那里是普通的继电器或寄存器。各机型的说明页（`rungc book special-devices/index`）和 `rungc explain D8393` 说明哪些软元件有效。只报告此处不会发生的故障（电池电压低、电源故障）的软元件不报告。

# special device without a meaning on the model
# The manual of the model gives this special relay or register no meaning, so nothing sets, clears or reads it but the program: a contact of it never changes. It may belong to another model, or be misspelt. Of a run of devices or a group of bits, which a program clears or copies as a whole, only the first is looked at; runs of more than 32 are not reported.
W0302 = 此机型中没有含义的特殊软元件
    .text = 机型的手册没有说明此特殊辅助继电器或特殊数据寄存器的含义，因此除程序外，没有任何东西置位、清零或读取它：它的触点从不变化。它可能属于其他机型，或写错了编号。程序成批清零或复制的一段软元件或位元件组合，只检查其中的第一个；超过 32 个的不报告。

# step number that does not fit the instructions before it
# The source numbers its steps, and the number differs from the steps that the instructions before it take on this model: the program may be for another model, or a row may be missing.
W0501 = 步号与前面的指令不符
    .text = 源文件带有步号，而步号与前面的指令在此机型上所占的步数不同：程序可能用于其他机型，或缺少一行。

# unknown CPU type
# The source names a CPU type that belongs to no supported model, and none resembles it. It is compiled for FX3U; `--model` selects another model.
W0502 = CPU 类型未知
    .text = 源文件中的 CPU 类型不属于任何支持的机型，也没有相近的机型。按 FX3U 编译；用 `--model` 选择其他机型。

# CPU type compiled as a similar model
# The source names a CPU type that is not a supported model. It is compiled for the most similar one; the help describes the differences. `--model` selects another model.
N0020 = CPU 类型按相近的机型编译
    .text = 源文件中的 CPU 类型不是支持的机型。按最相近的机型编译；提示说明两者的区别。用 `--model` 选择其他机型。

# errors under another model than the source names
# The source names a CPU type, but `--model` or `model` in rungc.toml selects another model, and under this one the program has errors. If these are instructions or devices that the model lacks, remove the setting, or set the model that the source names.
N0021 = 按不同于源文件的机型检查时有错误
    .text = 源文件写明了 CPU 类型，但 `--model` 或 rungc.toml 的 `model` 选择了其他机型，程序在该机型上有错误。如果错误是该机型没有的指令或软元件，删除此设置，或改为源文件写明的机型。

# program longer than the model's memory
# The program has more steps than the PLC can hold. Compiled code has no such limit, but the program cannot go back to the PLC.
W0503 = 程序超出机型的程序容量
    .text = 程序的步数超过 PLC 能够存放的步数。编译后的代码没有此限制，但程序不能再写回 PLC。

# bound of an operand that the program does not have
# `[index]` in rungc.toml names an operand with an index register that no instruction has, so the bound has no effect. A bound applies to the operand exactly as the program writes it: a bound for `D100Z0` does not cover `D101Z0`.
W0540 = 为程序中没有的操作数设置了范围
    .text = rungc.toml 的 `[index]` 写了一个带变址寄存器的操作数，但没有指令使用它，因此此范围不起作用。范围只适用于与程序写法完全相同的操作数：`D100Z0` 的范围不适用于 `D101Z0`。

# device that some PLCs of the model do not have
# The model stands for PLCs of several makers, and published tests of some of them report that a program with this device stops them. Compiled code has the device. Use a lower number, or try the program on the PLC that it is for.
N0022 = 此机型的部分 PLC 没有此软元件
    .text = 此机型代表多个厂家的 PLC，对其中一些产品的公开测试表明，含有此软元件的程序会使其停止。编译后的代码有此软元件。使用更小的编号，或在实际使用的 PLC 上试运行程序。

# indexed operand that makes the program store many devices
# A compiled program stores the devices that its operands can reach. The range of an index register is derived from constants, sums, masks (`WAND`), comparisons on the way, loop iterations and the values that all scans leave in it; a value from a data register or from communication can be anything (a host may write data registers, but not index registers), and then the operand reaches every device of its class. Compare or mask the index before use, or bound the operand in rungc.toml: `[index]`, `D100Z0 = "D100-D163"`. An access outside the bound is then PLC error 6706, as is an access outside the model's devices.
N0030 = 带变址的操作数使程序存储大量软元件
    .text = 编译后的程序存储其操作数能够访问的软元件。变址寄存器的范围由常数、加法、掩码（`WAND`）、执行途中的比较、循环次数以及每次扫描留在其中的值推算；来自数据寄存器或通信的值可以是任意值（宿主程序可以写数据寄存器，但不能写变址寄存器），此时操作数可以访问该类的全部软元件。使用前对变址进行比较或掩码，或在 rungc.toml 中限定操作数的范围：`[index]`、`D100Z0 = "D100-D163"`。超出此范围的访问，与超出机型软元件的访问一样，PLC 的错误代码为 6706。
