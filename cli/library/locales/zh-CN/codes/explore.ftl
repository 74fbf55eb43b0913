# an instruction can meet an operation error
# `rungc explore` has found inputs with which this instruction fails when the program runs: the PLC sets M8067, skips the instruction and continues. The run is in the report; `--write-test` writes it as a test file. Typical causes are an index register that leads beyond the devices, a division by 0, and a BCD number with digits above 9. `rungc explain` with the PLC's code, such as `rungc explain 6706`, says more.
E0830 = 指令可能发生运算错误
    .text = `rungc explore` 找到了一组输入，使此指令在程序运行时失败：PLC 置位 M8067，跳过此指令并继续运行。运行过程在报告中；`--write-test` 把它写成测试文件。常见原因有：变址寄存器指到软元件之外，除数为 0，BCD 数中有大于 9 的数位。用 PLC 的错误代码执行 `rungc explain`，如 `rungc explain 6706`，可了解更多。

# a scan can take so long that the watchdog stops the PLC
# `rungc explore` has found inputs with which a loop or a jump backward does not end in time: the PLC goes to STOP with M8061 set and all outputs off. Limit how often the loop runs.
E0831 = 一次扫描可能过长，使监视定时器停止 PLC
    .text = `rungc explore` 找到了一组输入，使循环或跳回前面的跳转不能及时结束：PLC 转入 STOP，M8061 为 ON，全部输出为 OFF。限制循环的次数。

# two coils drive an output differently in one scan
# `rungc explore` has found a scan in which one coil of the output is on and a later one is off: the last coil executed decides, so the output stays off although a rung asks for it. Join the conditions in one rung.
E0832 = 同一次扫描中两个线圈对输出的驱动不同
    .text = `rungc explore` 找到了一次扫描，其中输出的一个线圈为 ON，后面的一个为 OFF：由最后执行的线圈决定，因此虽然有网络要求输出接通，它仍为 OFF。把各条件合并到一个网络。

# an output can change in every scan while no input does
# `rungc explore` has found a state from which an output turns on and off in each scan, however long scans last: the rungs that drive it undo each other. A relay or a contactor is worn out in minutes by this.
E0833 = 输入不变时，输出可能每次扫描都变化
    .text = `rungc explore` 找到了一种状况，其中输出每次扫描都接通或断开，无论扫描多长：驱动它的各网络相互抵消。继电器或接触器几分钟就会因此损坏。

# an axis of the simulated machine can run into an end of its travel
# `rungc explore --machine` has found inputs with which the program drives an axis against its end stop. The run is in the report.
E0834 = 仿真机械的轴可能撞到行程末端
    .text = `rungc explore --machine` 找到了一组输入，使程序把轴驱动到行程极限。运行过程在报告中。

# a run that was found is not the same on all engines
# A run on the interpreter showed this, but emitted code did otherwise with the same inputs. That is an error of rungc: please report it with the program and the test file that `--write-test` writes.
E0835 = 找到的运行过程在各执行引擎上不一致
    .text = 解释器上的运行出现了这种情况，但生成的代码在相同输入下的结果不同。这是 rungc 的错误：请连同程序和 `--write-test` 写出的测试文件一起报告。
