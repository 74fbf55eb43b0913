# a serial port that is set up in two ways
# The program sets a register of the port to two different values in the same scan, so the last one decides; it wants two protocols or two formats on one port. Setting a register to 0 first is not reported.
W0601 = 串口有两种设置
    .text = 程序在同一次扫描中把端口的寄存器设为两个不同的值，由最后一个决定；这相当于要求一个端口有两种协议或两种通信格式。先把寄存器设为 0 的情况不报告。

# a Modbus master's instruction on a port that is not a master
# The instruction asks slaves by Modbus, but the registers of its port choose another protocol, so nothing is sent. ADPRW of L01S asks by Modbus RTU alone, RD3A and WR3A in ASCII, too. `D8126` = H20 makes COM1 of H1U and H2U an RTU master.
W0602 = 在非主站的端口上使用 Modbus 主站指令
    .text = 指令通过 Modbus 访问从站，但端口的寄存器选择了其他协议，因此什么也不发送。L01S 的 ADPRW 只用 Modbus RTU，RD3A 和 WR3A 也可用 ASCII。`D8126` = H20 使 H1U 和 H2U 的 COM1 成为 RTU 主站。

# RS on a port that serves another protocol
# RS and similar instructions send and receive characters of the program's own, but the registers of the port choose another protocol, so they do nothing.
W0603 = 在使用其他协议的端口上使用 RS
    .text = RS 等指令收发由程序自定的字符，但端口的寄存器选择了其他协议，因此这些指令不起作用。

# master and slave of a parallel link in one PLC
# M8070 makes the PLC the master of a parallel link, M8071 the slave. With both on, the link does not run, and M8073 comes on.
W0604 = 同一 PLC 既是并联协议的主站，又是从站
    .text = M8070 使 PLC 成为并联协议的主站，M8071 使其成为从站。两者都为 ON 时，通信不运行，M8073 变为 ON。

# a station number that no frame can name
# A Modbus slave has a station of 1 to 247, a slave of a computer link one of 0 to 15 (HM: 1 to 63). With another number the port answers no request.
W0605 = 没有帧能指定的站号
    .text = Modbus 从站的站号为 1～247，计算机链接的从站为 0～15（HM：1～63）。使用其他站号时，端口不应答任何请求。

# a protocol that is chosen after it is fixed
# H1U and H2U fix the protocol of each port at the end of the first scan in RUN. A register that is set only under some condition may be set too late, and then takes effect only after the PLC has been stopped and started again.
W0606 = 协议在确定之后才选择
    .text = H1U 和 H2U 在 RUN 后的第一次扫描结束时确定各端口的协议。只在某种条件下才设置的寄存器可能设置得太晚，要等 PLC 停止并再次启动之后才生效。

# a format word that names no bit rate
# Bits 4 to 7 of a format word stand for the bit rate: 3 is 300 bit/s, 8 is 9600 bit/s, 12 is 115,200 bit/s. This word has a value there that stands for none, so the port runs at 9600 bit/s.
W0607 = 通信格式中没有有效的比特率
    .text = 通信格式的位 4～7 表示比特率：3 为 300 bit/s，8 为 9600 bit/s，12 为 115200 bit/s。此字中的值不代表任何比特率，因此端口按 9600 bit/s 运行。

# a Modbus table without rows
# `D8126` = H60 makes COM1 of H1U and H2U a Modbus master that works through a table. The editor downloads the table beside the program; rungc takes its rows from `[[modbus]]` in rungc.toml. Without a row and without an instruction that asks, the port sends nothing.
W0608 = Modbus 表没有行
    .text = `D8126` = H60 使 H1U 和 H2U 的 COM1 成为按表运行的 Modbus 主站。编程软件把此表与程序一起下载；rungc 从 rungc.toml 的 `[[modbus]]` 读取各行。既没有行，又没有发出请求的指令时，端口什么也不发送。

# a number that an N:N link does not have
# `D8176` is the station of an N:N link, 0 to 7 (enhanced: 0 to 15), 0 the master alone; `D8177` in the master is the number of slaves, 1 to 7 (15), `D8178` the mode, 0 to 2. A slave with another station is never asked; a master takes a larger number of slaves as the largest, and another mode as 0.
W0609 = N:N 网络没有此数值
    .text = `D8176` 是 N:N 网络中的站号，0～7（增强型：0～15），只有主站为 0；主站中的 `D8177` 是从站的个数，1～7（15），`D8178` 是模式，0～2。其他站号的从站不会被访问；从站个数过大时，主站按最大值处理，模式为其他值时按 0 处理。

# a write that may set up a serial port through an index register
# The index decides which register the instruction writes, and some of those that it may reach choose a port's protocol, station or format. A compiled program contains only the protocols that instructions without an index choose. If this instruction alone chooses the protocol, the port of a compiled program stays silent, although it works in `rungc run` and `rungc test`. Name the register instead: `D8126`, not `D8120Z0`.
W0690 = 可能通过变址寄存器设置串口的写入
    .text = 变址决定指令写入哪个寄存器，而可能写到的寄存器中，有些用于选择端口的协议、站号或通信格式。编译后的程序只包含由不带变址的指令所选择的协议。如果只有此指令选择协议，虽然在 `rungc run` 和 `rungc test` 中能工作，编译后的程序的端口却没有通信。直接写出寄存器：用 `D8126`，不用 `D8120Z0`。

# a port that is set up for an Ethernet card
# `D8270` = HC1, `D8271` = 1 and `D8276` = 2 set up COM3 of H2U for the card H2U-ENET-BD, which serves registers D by Modbus TCP. There is no card beside a compiled program, and its IP address, shared registers and table of requests are in the editor's project, not in the program. COM3 is a Modbus RTU slave. `rungc run --modbus-tcp`, `[serve] modbus-tcp` and executables of `rungc build --servers` serve all devices by Modbus TCP at the addresses that the card has (D500 is 1F4h); rows of `[[modbus]]` with `host` ask other servers, as the card's table does. With `modbus-tcp` or such a row in rungc.toml, and with `run --modbus-tcp`, this is not reported.
W0700 = 端口设置为用于以太网卡
    .text = `D8270` = HC1、`D8271` = 1、`D8276` = 2 把 H2U 的 COM3 设置为用于 H2U-ENET-BD 卡，此卡通过 Modbus TCP 提供寄存器 D。编译后的程序没有此卡，卡的 IP 地址、共享寄存器和请求表在编程软件的工程中，不在程序中。COM3 成为 Modbus RTU 从站。`rungc run --modbus-tcp`、`[serve] modbus-tcp` 和 `rungc build --servers` 生成的可执行文件通过 Modbus TCP 提供全部软元件，地址与此卡相同（D500 为 1F4h）；`[[modbus]]` 中带 `host` 的行与卡的请求表一样，访问其他服务器。rungc.toml 中有 `modbus-tcp` 或这样的行时，以及使用 `run --modbus-tcp` 时，不报告此警告。

# a program of CANlink that writes registers of the network
# On a station of CANlink, D7800 to D7863 are the states of the stations. The system writes them in each scan, and the manual forbids a master's program to write D7000 to D7999.
W0701 = 使用 CANlink 的程序写入了 CANlink 网络的寄存器
    .text = 在 CANlink 的站中，D7800～D7863 是各站的状态。系统每次扫描都写入它们，而手册禁止主站的程序写入 D7000～D7999。

# remote modules beside CANlink
# The manual does not allow FROM and TO of a master beside the configuration of CANlink 3.0. Both use the one CAN card, for remote modules (100 and their station) with another version of CANlink. A compiled program reaches both, if its hardware does.
W0702 = CANlink 与远程模块同时使用
    .text = 手册不允许主站在使用 CANlink 3.0 配置的同时用 FROM 和 TO 访问远程模块。两者使用同一块 CAN 卡，而远程模块（100 加站号）使用另一版本的 CANlink。只要硬件能访问两者，编译后的程序就能访问。

# a link whose frames the manuals do not print
# The manuals describe the registers and the effect of this link, but not its frames. rungc uses its own frames, so all partners have to run programs of rungc: a compiled program cannot replace one PLC among others. `rungc book links` describes the frames.
N0601 = 手册没有给出帧格式的通信
    .text = 手册说明了此通信的寄存器和作用，但没有给出帧的内容。rungc 使用自己的帧，因此所有的通信伙伴都必须运行 rungc 的程序：编译后的程序不能替代多台 PLC 中的一台。`rungc book links` 说明这些帧。
