# FOR without NEXT
# Every FOR needs a NEXT after it, before FEND, END and the end of the routine.
E0412 = FOR 缺少对应的 NEXT
    .text = 每个 FOR 之后都需要 NEXT，并且位于 FEND、END 和子程序、中断程序的结尾之前。

# NEXT without FOR
# NEXT closes the innermost open FOR; none is open here.
E0413 = NEXT 缺少对应的 FOR
    .text = NEXT 结束最内层的 FOR；此处没有尚未结束的 FOR。

# FOR nested too deep
# Loops nest five deep (six on H1U and H2U).
E0414 = FOR 嵌套过深
    .text = 循环最多嵌套 5 层（H1U 和 H2U 为 6 层）。

# MC without MCR
# A master control zone ends with MCR of the same level.
E0415 = MC 缺少对应的 MCR
    .text = 主控区间以相同嵌套级的 MCR 结束。

# MCR without MC
# No master control zone of this level is open here.
E0416 = MCR 缺少对应的 MC
    .text = 此处没有此嵌套级的主控区间。

# levels of MC out of order
# Zones nest from N0 to N7: an inner zone has a higher level than the one around it.
E0417 = MC 的嵌套级顺序不对
    .text = 主控区间按 N0～N7 嵌套：内层区间的嵌套级大于外层。

# step ladder without RET
# The last state of a step ladder is followed by RET.
E0418 = 步进梯形图缺少 RET
    .text = 步进梯形图的最后一个状态之后是 RET。

# RET outside a step ladder
# RET ends the states that STL starts; no state is open here.
E0419 = RET 不在步进梯形图中
    .text = RET 结束由 STL 开始的各状态；此处没有尚未结束的状态。

# nine or more STL in a row
# Consecutive STL wait for parallel branches, of which there are at most eight.
E0420 = 连续 9 个以上的 STL
    .text = 连续的 STL 等待各并行分支，而并行分支最多 8 个。

# structure inside another that must not contain it
# Master control and step ladders belong in the main program, outside loops; routines belong after FEND, outside everything else. h1u-h2u-programming §8.8 lists what may contain what.
E0421 = 结构位于不允许包含它的结构之中
    .text = 主控和步进梯形图应位于主程序中、循环之外；子程序和中断程序应位于 FEND 之后、其他结构之外。h1u-h2u-programming 8.8 节列出哪些结构可以包含哪些结构。

# structures that cross
# Of two structures, one must be entirely inside or entirely outside the other.
E0422 = 结构相互交叉
    .text = 两个结构中，一个必须完全位于另一个之内或之外。

# FEND inside another structure
# FEND ends the main program: loops, master control zones, step ladders and routines must be closed before it.
E0423 = FEND 位于其他结构之中
    .text = FEND 结束主程序：循环、主控区间、步进梯形图、子程序和中断程序必须在它之前结束。

# routine without SRET or IRET
# A subroutine ends with SRET, an interrupt routine with IRET.
E0424 = 子程序或中断程序缺少 SRET 或 IRET
    .text = 子程序以 SRET 结束，中断程序以 IRET 结束。

# SRET or IRET outside a routine
# SRET ends a subroutine that starts with its label P, IRET an interrupt routine that starts with its pointer I; both come after FEND.
E0425 = SRET 或 IRET 不在子程序或中断程序中
    .text = SRET 结束以标号 P 开始的子程序，IRET 结束以指针 I 开始的中断程序；两者都位于 FEND 之后。

# routine in the main program
# Subroutines and interrupt routines come after FEND, which ends the main program.
E0426 = 主程序中有子程序或中断程序
    .text = 子程序和中断程序位于 FEND 之后，FEND 结束主程序。

# program without END
# The last instruction of a program is END.
E0427 = 程序缺少 END
    .text = 程序的最后一条指令是 END。

# instruction used more often than the model allows
# Some instructions reserve a part of the hardware or of the system's memory, and a program may contain only one or two of them.
E0429 = 指令的使用次数超过机型的限制
    .text = 有些指令占用一部分硬件或系统存储器，因此一个程序只能含有一条或两条这样的指令。
