# fleet.toml describes no fleet that can run
# fleet.toml says which programs run how often, and what their PLCs are connected to: `[fleet]` with the cycle, `[broker]` with the address of a broker, and a table `[plc.NAME]` for each program. An unknown table or key is rejected, because a misspelt one would otherwise be ignored. `rungc book fleet` explains the keys.
E0870 = fleet.toml 没有描述可运行的多机联动
    .text = fleet.toml 说明运行哪些程序、各运行多少台，以及这些 PLC 与什么连接：`[fleet]` 写周期，`[broker]` 写 MQTT 服务器的地址，每个程序有一个表 `[plc.NAME]`。未知的表或键会被拒绝，否则拼错的键会被忽略。`rungc book fleet` 说明各个键。

# the PLCs of a fleet cannot run on this engine
# `engine = "lanes"` runs 64 PLCs at once in emitted C, which the C compiler `cc` of this machine builds. A program that takes interrupts, sends pulses, uses serial ports, calls the runtime library, stops itself or has a loop that only the watchdog may end does not run so; the message says which of these it is. `engine = "c"` runs the PLCs of a program in emitted C one after the other; there it may call the runtime library, which needs Rust, if it asks no hardware, and may stop. Write `engine = "interp"`, or leave the key out: then the PLCs run on the fastest engine that runs the program.
E0871 = 多机联动的 PLC 不能在此执行引擎上运行
    .text = `engine = "lanes"` 用生成的 C 代码同时运行 64 台 PLC，由本机的 C 编译器 `cc` 编译。有下列情况的程序不能这样运行：使用中断、发出脉冲、使用串口、调用运行库、自行停止，或有只能由监视定时器结束的循环；消息会说明是哪一种。`engine = "c"` 用生成的 C 代码逐台运行一个程序的各台 PLC；此时程序可以调用需要 Rust 的运行库（如果不使用硬件），也可以自行停止。写成 `engine = "interp"`，或省略此键：PLC 将在能够运行此程序的最快的执行引擎上运行。

# a fleet sets a device that cannot be set
# A setting of `set` is a device, its value and perhaps a time: `X000=1@200ms`. It names a device of the model that takes this value. Channels of special modules and characters cannot be set in a fleet.
E0872 = 多机联动设置了不能设置的软元件
    .text = `set` 的一项设置由软元件、值和可选的时间组成：`X000=1@200ms`。软元件必须是机型所有，并能接受此值。特殊模块的通道和字符不能在多机联动中设置。

# a port of a fleet cannot be opened
# With `modbus-tcp`, each PLC has the port after that of the PLC before it, or with `units` as many PLCs share a port. One of these ports is taken by another program, is above 65535, or the system allows no more open files (`ulimit -n`). Begin at another port, or let PLCs share ports.
E0873 = 多机联动的端口无法打开
    .text = 使用 `modbus-tcp` 时，每台 PLC 使用前一台的下一个端口；使用 `units` 时，多台 PLC 共用一个端口。其中某个端口已被其他程序占用，或大于 65535，或系统不允许再打开文件（`ulimit -n`）。从其他端口开始，或让多台 PLC 共用端口。
