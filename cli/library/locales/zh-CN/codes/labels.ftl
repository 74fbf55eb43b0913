# jump or call to a label that does not exist
# CJ and CALL name a label P that must exist somewhere in the program.
E0430 = 跳转或调用的标号不存在
    .text = CJ 和 CALL 指定的标号 P 必须在程序中存在。

# label defined twice
# A pointer P or I may be defined only once. Labels of jumps and of subroutines share their numbers.
E0431 = 标号重复定义
    .text = 指针 P 或 I 只能定义一次。跳转的标号和子程序的标号共用编号。

# label that is both jumped to and called
# CJ continues at its label; CALL returns from it with SRET: they cannot share a label.
E0432 = 同一标号既用于跳转，又用于调用
    .text = CJ 从标号处继续执行；CALL 用 SRET 从标号处返回：两者不能共用一个标号。

# P63 as a label or a subroutine
# P63 is the end of the program: CJ P63 jumps to END. It must not be defined, and it cannot be called.
E0433 = P63 用作标号或子程序
    .text = P63 是程序的结束：CJ P63 跳转到 END。它不能定义，也不能调用。

# jump into a loop
# A jump from outside to a label between FOR and NEXT would run a loop that was never started. The same applies to PROC and PEND of HM's advanced interrupts, where a routine is left and re-entered.
E0434 = 跳转到循环内部
    .text = 从外部跳转到 FOR 与 NEXT 之间的标号，会执行一个从未开始的循环。HM 高级中断的 PROC 和 PEND 也一样，程序在那里离开并重新进入。

# jump into or out of a routine
# A jump stays within the main program, or within its subroutine or interrupt routine.
E0435 = 跳入或跳出子程序、中断程序
    .text = 跳转只能在主程序之内，或在同一个子程序、中断程序之内。

# calls nested too deep
# Calls nest five deep on most models (eight on HM). These calls are made in every scan, so the PLC reports the error in every scan.
E0437 = 调用嵌套过深
    .text = 多数机型的调用最多嵌套 5 层（HM 为 8 层）。这些调用每次扫描都执行，因此 PLC 每次扫描都报告错误。

# calls that may nest too deep
# Calls nest five deep on most models (eight on HM). Whether these do depends on their conditions: if all of them are on at once, the call beyond the limit is skipped with error 6702.
W0510 = 调用可能嵌套过深
    .text = 多数机型的调用最多嵌套 5 层（HM 为 8 层）。是否超过取决于各调用的条件：如果条件同时全部接通，超出限制的调用将被跳过，错误代码为 6702。

# two interrupts of one source
# An input triggers an interrupt on its rising or its falling edge, not on both; a timer interrupt has one period.
E0440 = 同一中断源有两个中断
    .text = 一个输入只能用上升沿或下降沿触发中断，不能两者都用；一个定时器中断只有一个周期。

# fast input used by a counter and something else
# Each fast input serves one purpose: a high-speed counter, an input interrupt or pulse catch.
E0441 = 快速输入同时用于计数器和其他用途
    .text = 每个快速输入只能有一种用途：高速计数器、输入中断或脉冲捕捉。

# two high-speed counters on one input
# Each fast input serves one high-speed counter.
E0442 = 同一输入有两个高速计数器
    .text = 每个快速输入只能用于一个高速计数器。

# interrupt without a routine
# DHSCS may request an interrupt instead of setting a bit; its routine must follow FEND.
E0443 = 中断没有对应的中断程序
    .text = DHSCS 可以请求中断，而不是置位某一位；其中断程序必须位于 FEND 之后。
