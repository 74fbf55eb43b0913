# 0, as in a new PLC
t-0-as-in-a-new-plc-7540a452 = 0，如同新的 PLC

# 1E
t-1e-48eb711b = 1E

# 3E
t-3e-1cefa905 = 3E

# A PlatformIO library: C, `library.json`, an example
t-a-platformio-library-c-library-json-an-example-6fa56891 = PlatformIO 库：C、`library.json`、一个示例

# A Rust crate
t-a-rust-crate-4da53ef5 = Rust crate

# A UF2 image for a board with an RP2040
t-a-uf2-image-for-a-board-with-an-724f816b = 用于 RP2040 电路板的 UF2 映像

# A Zephyr module: C, `zephyr/module.yml`, a sample
t-a-zephyr-module-c-zephyr-module-yml-a-17af96fd = Zephyr 模块：C、`zephyr/module.yml`、一个示例

# A condition that must be reachable: some run ends with it
t-a-condition-that-must-be-reachable-some-run-6e085313 = 必须能够达到的条件：有某次运行以它结束

# A condition that must hold after every scan
t-a-condition-that-must-hold-after-every-scan-375dc2ba = 每次扫描之后都必须成立的条件

# A condition that must not hold after any scan: `"Y000 & Y001"`. Devices are named as in test files (`rungc book prove`) or by their comments; `!`, `&`, `|` and comparisons (`D0 > 100`) combine them. May be repeated, as can the options below
t-a-condition-that-must-not-hold-after-any-205f15a4 = 任何扫描之后都不得成立的条件：`"Y000 & Y001"`。软元件的名称与测试文件相同（`rungc book prove`），或为其注释；`!`、`&`、`|` 和比较（`D0 > 100`）可组合。可重复给出，以下选项也一样

# A condition that the machine guarantees after every scan: `"!(X000 & X001)"`
t-a-condition-that-the-machine-guarantees-after-every-5870de90 = 机器在每次扫描之后保证的条件：`"!(X000 & X001)"`

# A diagnostic code (E0106), an error code of the PLC (6706), an instruction (ADD, LD>=), a special device (M8013), a model (fx3u) or a variant of one (h2u-mtq), a safety function (two-hand; `functions` lists them), or a page that `rungc book` lists
t-a-diagnostic-code-e0106-an-error-code-of-333a0e36 = 诊断代码（E0106）、PLC 的错误代码（6706）、指令（ADD、LD>=）、特殊软元件（M8013）、机型（fx3u）或其变型（h2u-mtq）、安全功能（two-hand；用 `functions` 列出），或 `rungc book` 列出的页面

# A folder of C99
t-a-folder-of-c99-d98b5546 = C99 的文件夹

# A folder with a static library and its headers (built from C)
t-a-folder-with-a-static-library-and-its-93408fff = 含静态库及其头文件的文件夹（由 C 编译）

# A functional mock-up unit for co-simulation (FMI 3.0), built from C
t-a-functional-mock-up-unit-for-co-simulation-f3dc8a7b = 用于联合仿真的功能样机单元 FMU（FMI 3.0，由 C 编译）

# A page with a search
t-a-page-with-a-search-1cdb679a = 带搜索的页面

# A page with the ladder diagram
t-a-page-with-the-ladder-diagram-52b74d0f = 带梯形图的页面

# A page with the old and new drawing of each network
t-a-page-with-the-old-and-new-drawing-2c484b0e = 一个页面，含各网络的旧图和新图

# A picture of the networks that differ, before and after
t-a-picture-of-the-networks-that-differ-before-1bc0dd98 = 不同网络在更改前后的图

# A property is a condition on the devices after a scan, such as `Y000 & Y001`. Exit codes: 0: proved; 1: violated; 2: incorrect usage, or errors in the program; 3: undecided
t-a-property-is-a-condition-on-the-devices-8ae3a554 = 性质是对扫描后软元件的条件，例如 `Y000 & Y001`。退出码：0：已证明；1：被违反；2：用法错误，或程序有错误；3：未能判定

# A table (CSV) of devices as tags of a SCADA system: names, types, Modbus addresses
t-a-table-csv-of-devices-as-tags-of-f656b7fa = 作为 SCADA 系统标签的软元件表格（CSV）：名称、类型、Modbus 地址

# A table (CSV) of the terminals, used and free, with their comments
t-a-table-csv-of-the-terminals-used-and-47cab46e = 端子的表格（CSV），包括已用和空闲的，带注释

# A table (CSV) with a line for each use
t-a-table-csv-with-a-line-for-each-50f76fdf = 每次使用一行的表格（CSV）

# A table at first, then a line for each change
t-a-table-at-first-then-a-line-for-76f4d31f = 先输出表格，然后每次变化一行

# Accept all current traces
t-accept-all-current-traces-9b853c23 = 接受全部当前轨迹

# Add NAME_lanes.h and rungc_lanes.h to emitted C: run this many instances of the program at once, a bit device of all of them in one word (`rungc book lanes`)
t-add-name-lanes-h-and-rungc-lanes-h-a84ff63f = 在生成的 C 中增加 NAME_lanes.h 和 rungc_lanes.h：同时运行这么多个程序实例，所有实例的同一位软元件在一个字中（`rungc book lanes`）

# Add NAME_retain.h and rungc_retain.h to emitted C: save latched devices to flash and load them (`rungc book retain`). Emitted Rust has `Program::retained` for this
t-add-name-retain-h-and-rungc-retain-h-b6219ac3 = 在生成的 C 中增加 NAME_retain.h 和 rungc_retain.h：把停电保持的软元件保存到闪存并读回（`rungc book retain`）。生成的 Rust 为此提供 `Program::retained`

# Add a main program for a host that scans in real time
t-add-a-main-program-for-a-host-that-2041e465 = 为主机增加以实际时间扫描的主程序

# Add functions that read and write devices by number and by name to emitted C (`rungc book embedding`)
t-add-functions-that-read-and-write-devices-by-7b53cb32 = 在生成的 C 中增加按编号和按名称读写软元件的函数（`rungc book embedding`）

# Add misra.txt to emitted C: deviations from MISRA C:2012, as suppressions for cppcheck (`rungc book builds`)
t-add-misra-txt-to-emitted-c-deviations-from-09e39ba4 = 在生成的 C 中增加 misra.txt：对 MISRA C:2012 的偏离，作为 cppcheck 的抑制项（`rungc book builds`）

# Add the feature `defmt` to emitted Rust: with it, defmt prints the program's state and errors (`rungc book builds`)
t-add-the-feature-defmt-to-emitted-rust-with-5b70d98b = 在生成的 Rust 中增加特性 `defmt`：由 defmt 输出程序的状态和错误（`rungc book builds`）

# Address of the first byte, for files that are not ELF
t-address-of-the-first-byte-for-files-that-78ae1346 = 首字节的地址，用于非 ELF 文件

# All three
t-all-three-c14d3ee4 = 以上三种

# Allow each server this many connections at once (default: 64). One more is rejected, unless another one has been silent for a minute
t-allow-each-server-this-many-connections-at-once-2f8b97fb = 每个服务器同时允许这么多连接（默认：64）。再多的连接被拒绝，除非另有连接已静默一分钟

# Also list general devices that no instruction uses; the page and JSON always do
t-also-list-general-devices-that-no-instruction-uses-d1ed6dd9 = 还列出没有指令使用的一般软元件；页面和 JSON 总是列出

# Also report dead logic, with a proof of each: coils that are never on, rungs without effect, steps that are never reached or left, comparisons with one result, timers that never expire; and outputs that change in every scan. Takes at most 20 seconds per program. Implies --draw
t-also-report-dead-logic-with-a-proof-of-c0bc5e2f = 还报告无效逻辑，并各附证明：从不 ON 的线圈、没有作用的梯级、从不到达或离开的步、结果恒定的比较、从不到时的定时器；以及每次扫描都变化的输出。每个程序最多用 20 秒。隐含 --draw

# Also write a proof of each formula (`*.drat`, DRAT) for a proof checker; made by `cadical`, which must be installed
t-also-write-a-proof-of-each-formula-drat-57dfd44d = 还写出每个公式的证明（`*.drat`，DRAT），供证明检查器使用；由须已安装的 `cadical` 生成

# Always
t-always-ad4bbd04 = 总是

# An AGENTS.md that is there already is kept
t-an-agents-md-that-is-there-already-is-ccdb1d66 = 已有的 AGENTS.md 保持不变

# An Arduino library: C, `library.properties`, a sketch
t-an-arduino-library-c-library-properties-a-sketch-f7105073 = Arduino 库：C、`library.properties`、一个 sketch

# An ESP-IDF component: C, `idf_component.yml`, an example
t-an-esp-idf-component-c-idf-component-yml-e2988f0a = ESP-IDF 组件：C、`idf_component.yml`、一个示例

# An LCOV tracefile, for genhtml and coverage services
t-an-lcov-tracefile-for-genhtml-and-coverage-services-a70af468 = LCOV 跟踪文件，用于 genhtml 和覆盖率服务

# An executable for this machine (built from C)
t-an-executable-for-this-machine-built-from-c-4f360fc6 = 本机的可执行文件（由 C 编译）

# An image for a board
t-an-image-for-a-board-6f3e5dd7 = 电路板的映像

# Apply safe fixes to instruction lists, and report the remaining diagnostics
t-apply-safe-fixes-to-instruction-lists-and-report-01cd4e53 = 对指令表应用安全的修复，并报告其余诊断

# Arguments
t-arguments-a33c193f = 参数

# At the end, reports the number of scans, missed scans, the latency of their start, and memory per PLC
t-at-the-end-reports-the-number-of-scans-381e92c9 = 结束时报告扫描次数、错过的扫描、扫描开始的延迟以及每台 PLC 的内存

# Axes that reach an end of their travel
t-axes-that-reach-an-end-of-their-travel-55239f3b = 到达行程终点的轴

# Bit rate. At a programming port, the format is always 7 data bits, even parity, 1 stop bit
t-bit-rate-at-a-programming-port-the-format-f0b0894b = 波特率。编程口的格式总是 7 个数据位、偶校验、1 个停止位

# Bit rate; the boot loader measures it
t-bit-rate-the-boot-loader-measures-it-225c7b05 = 波特率；引导程序自行测定

# Board for an image: a name that `rungc boards` lists, or a description (`rungc book boards`); with c or rust, writes the sources of the image
t-board-for-an-image-a-name-that-rungc-ca65534b = 映像的电路板：`rungc boards` 列出的名称，或描述文件（`rungc book boards`）；用于 c 或 rust 时，写出映像的源程序

# Board to show: a name, or a description (`rungc book boards`). Default: list all boards
t-board-to-show-a-name-or-a-description-07a1a040 = 要显示的电路板：名称，或描述文件（`rungc book boards`）。默认：列出所有电路板

# Build an image that checks the wiring of pins: it reports inputs over a serial port, and switches one output at a time when a key is sent to it
t-build-an-image-that-checks-the-wiring-of-090e32f3 = 编译检查引脚接线的映像：通过串口报告输入，并在收到按键时逐个接通输出

# C: the default
t-c-the-default-b7b883aa = C：默认

# Change nothing: list the lines that are not formatted, and fail (exit code 1) if there are any
t-change-nothing-list-the-lines-that-are-not-cc0e904f = 不作更改：列出未整理的行，如有则失败（退出码 1）

# Change nothing: list the lines that would change
t-change-nothing-list-the-lines-that-would-change-8ebf0c6e = 不作更改：列出将会改变的行

# Check a program without compiling it
t-check-a-program-without-compiling-it-3040772b = 检查程序，不编译

# Command whose page is printed. Default: the page of rungc itself
t-command-whose-page-is-printed-default-the-page-643ce2f5 = 要输出 man 页的命令。默认：rungc 本身的 man 页

# Commands
t-commands-971550f3 = 命令

# Communicate over standard input and output, as always: editors pass this option
t-communicate-over-standard-input-and-output-as-always-b0e7b5a2 = 总是通过标准输入和输出通信：编辑器会给出此选项

# Compare behaviour: list the devices that can have different values. Determines the exit code
t-compare-behaviour-list-the-devices-that-can-have-887df689 = 比较行为：列出可能具有不同值的软元件。决定退出码

# Compare the program in the PLC with the file first, which takes as long as `rungc read`
t-compare-the-program-in-the-plc-with-the-315b2727 = 先把 PLC 中的程序与文件比较，所需时间与 `rungc read` 相同

# Compare two programs network by network, or by behaviour
t-compare-two-programs-network-by-network-or-by-61562211 = 按网络或按行为比较两个程序

# Compare with this older program instead: can an output differ, given the same inputs at the same times?
t-compare-with-this-older-program-instead-can-an-3ea995f4 = 改为与这个旧程序比较：在相同时刻给出相同输入，输出是否会不同

# Compile FX-family PLC programs to C and Rust
t-compile-fx-family-plc-programs-to-c-and-dcf01d3e = 把 FX 系列 PLC 程序编译为 C 和 Rust

# Compile a program to C, Rust or an executable, or print its IR
t-compile-a-program-to-c-rust-or-an-5cb0596a = 把程序编译为 C、Rust 或可执行文件，或输出其 IR

# Connect a serial port of the PLC to one of this machine (`COM1=/dev/ttyUSB0`), to a new pseudo-terminal that clients open (`COM1=pty`), to a serial device server (`COM1=tcp:HOST:PORT`), or to the client of a socket (`COM1=tcp-listen:4001`). Runs in real time. The program sets the line's format and protocol. A lost device is reopened
t-connect-a-serial-port-of-the-plc-to-c9d06b26 = 把 PLC 的串口连接到本机的串口（`COM1=/dev/ttyUSB0`）、供客户端打开的新伪终端（`COM1=pty`）、串口设备服务器（`COM1=tcp:HOST:PORT`）或套接字的客户端（`COM1=tcp-listen:4001`）。以实际时间运行。线路的格式和协议由程序设定。丢失的设备会重新打开

# Connect terminals and registers as described by the tables `[io.NAME]` of this file (rungc.toml, `rungc book linux`): Modbus remote I/O, an MQTT broker, pins (Linux), files, standard input and output. Runs in real time. `rungc serve` uses the project's rungc.toml
t-connect-terminals-and-registers-as-described-by-the-f6d0c108 = 按此文件（rungc.toml，`rungc book linux`）的表 `[io.NAME]` 连接端子和寄存器：Modbus 远程 I/O、MQTT 代理、引脚（Linux）、文件、标准输入和输出。以实际时间运行。`rungc serve` 使用项目的 rungc.toml

# Connect the CAN card of H1U and H2U to a CAN interface of this machine (`can0`, Linux), or to an SLCAN adapter, with the bit rate in kbit/s (default 500): `slcan:/dev/ttyACM0,250`, `slcan:pty`. Runs in real time
t-connect-the-can-card-of-h1u-and-h2u-96bc3949 = 把 H1U 和 H2U 的 CAN 卡连接到本机的 CAN 接口（`can0`，Linux），或 SLCAN 适配器，附 kbit/s 波特率（默认 500）：`slcan:/dev/ttyACM0,250`、`slcan:pty`。以实际时间运行

# Convert a program to an instruction list, list export, ladder drawing, PLCopen XML or program memory
t-convert-a-program-to-an-instruction-list-list-90e3cac5 = 把程序转换为指令表、列表导出文件、梯形图、PLCopen XML 或程序存储器内容

# Count steps, instructions and devices, and estimate the scan time of the real PLC
t-count-steps-instructions-and-devices-and-estimate-the-c646d887 = 统计步数、指令和软元件，并估算实际 PLC 的扫描时间

# Debug a program in an editor over the Debug Adapter Protocol
t-debug-a-program-in-an-editor-over-the-bc2a9845 = 通过调试适配器协议（DAP）在编辑器中调试程序

# Declarations of all labels of a GX Works2 project, with the devices that the compiler chose
t-declarations-of-all-labels-of-a-gx-works2-381351aa = GX Works2 项目中全部标号的声明，带编译器所选的软元件

# Delete pending traces of earlier tests
t-delete-pending-traces-of-earlier-tests-d9135d1f = 删除先前测试的待定轨迹

# Description of the fleet: programs, number of PLCs of each, and connections (`rungc book fleet`)
t-description-of-the-fleet-programs-number-of-plcs-2d29f613 = 机群的描述：程序、各程序的 PLC 台数和连接（`rungc book fleet`）

# Device comments, as the editors export them (`COMMENT.csv`)
t-device-comments-as-the-editors-export-them-comment-737a0f36 = 软元件注释，如编辑器导出的文件（`COMMENT.csv`）

# Device to explain: `Y000`, `T0`, `D10`, or a comment
t-device-to-explain-y000-t0-d10-or-a-705fe716 = 要说明的软元件：`Y000`、`T0`、`D10`，或注释

# Device, or its comment
t-device-or-its-comment-8a834351 = 软元件或其注释

# Devices of the variables of PLCopen XML: a table of rows such as `Start,X000`; `*,M100-M199` lists devices for variables without an address
t-devices-of-the-variables-of-plcopen-xml-a-b9ce7611 = PLCopen XML 变量的软元件：由 `Start,X000` 这样的行组成的表；`*,M100-M199` 为没有地址的变量列出软元件

# Devices that something other than the program may write at any time, such as an operator panel: `M100..M115`; may be separated by commas
t-devices-that-something-other-than-the-program-may-51bb39ca = 程序以外的某物（如操作面板）可随时写入的软元件：`M100..M115`；可用逗号分隔

# Devices to show: `X000`, `T0`, `D10`, or a comment. Default: the inputs and outputs that the program names
t-devices-to-show-x000-t0-d10-or-a-35716498 = 要显示的软元件：`X000`、`T0`、`D10`，或注释。默认：程序使用的输入和输出

# Devices to show: `Y000`, `Y000..Y007`, `T0`, `D0`, a pair of registers as an integer (`D0.i32`), a float (`D0.f32`) or characters (`D0.str`), a group of bits (`K4M0`), pulses sent by an output (`Y000.pulses`, `Y000.hz`), a comment (`Main contactor`). Default: what the program writes, outputs first, and the inputs that change, up to twelve
t-devices-to-show-y000-y000-y007-t0-d0-12863722 = 要显示的软元件：`Y000`、`Y000..Y007`、`T0`、`D0`、作为整数的一对寄存器（`D0.i32`）、浮点数（`D0.f32`）或字符（`D0.str`）、位组（`K4M0`）、输出发出的脉冲（`Y000.pulses`、`Y000.hz`）、注释（`Main contactor`）。默认：程序写入的软元件（输出在前）和有变化的输入，最多十二个

# Do not ask before erasing
t-do-not-ask-before-erasing-90fb4522 = 擦除之前不询问

# Do not optimise the IR
t-do-not-optimise-the-ir-1bb57b95 = 不优化 IR

# Do not search for this kind of finding; may be repeated or separated by commas
t-do-not-search-for-this-kind-of-finding-394c3b74 = 不搜索此类发现；可重复给出或用逗号分隔

# Draw a program as a ladder diagram
t-draw-a-program-as-a-ladder-diagram-822f5e50 = 把程序画成梯形图

# Draw only networks that contain these devices: `M100`, `D100..D199` or a comment; may be repeated or separated by commas
t-draw-only-networks-that-contain-these-devices-m100-bd5cd82e = 只画含有这些软元件的网络：`M100`、`D100..D199` 或注释；可重复给出或用逗号分隔

# Draw only networks with a diagnostic of this code: `E0404`; may be repeated or separated by commas
t-draw-only-networks-with-a-diagnostic-of-this-0460a2c1 = 只画有此代码诊断的网络：`E0404`；可重复给出或用逗号分隔

# Draw only these networks, by number: `12` or `12..20`; may be repeated or separated by commas
t-draw-only-these-networks-by-number-12-or-dceab59e = 只画这些编号的网络：`12` 或 `12..20`；可重复给出或用逗号分隔

# Draw positions and speeds of the machine's axes and of pulse outputs, and watched devices, as an SVG; overwrites an earlier drawing
t-draw-positions-and-speeds-of-the-machine-s-92eb01e2 = 把机器各轴和脉冲输出的位置和速度以及所显示的软元件画成 SVG；覆盖先前的图

# Draw the last samples of HM's oscilloscope (D8030 to D8043) as an SVG, and write them as a table to a `.csv` file of the same name; overwrites earlier ones
t-draw-the-last-samples-of-hm-s-oscilloscope-039f77ef = 把 HM 示波器（D8030 至 D8043）的最后采样画成 SVG，并写成同名的 `.csv` 表格；覆盖先前的文件

# Draw the sequential function chart of the step ladder instead of the networks
t-draw-the-sequential-function-chart-of-the-step-8af86334 = 画步进梯形图的顺序功能图，而不是网络

# Duration of the run: `200ms`, `5s`, `2min`, `1h`; a bare number is milliseconds. Default: until Ctrl-C
t-duration-of-the-run-200ms-5s-2min-1h-c510c5ce = 运行的时长：`200ms`、`5s`、`2min`、`1h`；单独的数字为毫秒。默认：直到 Ctrl-C

# Emitted C
t-emitted-c-fb43f436 = 生成的 C

# Emitted C that runs 64 sequences of inputs at once
t-emitted-c-that-runs-64-sequences-of-inputs-72e3a801 = 生成的 C，同时运行 64 个输入序列

# Emitted Rust
t-emitted-rust-2e7f6873 = 生成的 Rust

# Endless scans
t-endless-scans-f5fb4bf5 = 不结束的扫描

# Engine of the search. Does not affect the results
t-engine-of-the-search-does-not-affect-the-b3cb47d5 = 搜索的引擎。不影响结果

# Engine to run the cases on. Default: that of rungc.toml, else the interpreter
t-engine-to-run-the-cases-on-default-that-13d8e474 = 运行用例的引擎。默认：rungc.toml 中的引擎，否则为解释器

# Engines that must confirm a run before it is reported, in addition to the interpreter; those of C and Rust are built first. `all`: those that can be built here
t-engines-that-must-confirm-a-run-before-it-0e980233 = 报告运行过程之前除解释器外还须确认它的引擎；C 和 Rust 的引擎先行编译。`all`：此处能编译的全部引擎

# Engines that must confirm each finding before it is reported; those of C and Rust are built first
t-engines-that-must-confirm-each-finding-before-it-c993f2ea = 报告发现之前必须确认它的引擎；C 和 Rust 的引擎先行编译

# Even parity
t-even-parity-513c0b7e = 偶校验

# Executables and main programs take --io FILE, which connects terminals and registers to remote I/O, brokers, pins and files as `rungc run` does, and --log FILE. They need the runtime library (`rungc book linux`)
t-executables-and-main-programs-take-io-file-which-2ad79435 = 可执行文件和主程序与 `rungc run` 一样接受 --io FILE，把端子和寄存器连接到远程 I/O、代理、引脚和文件，并接受 --log FILE。需要运行时库（`rungc book linux`）

# Executables and main programs take --modbus-tcp, --mc and --fx, as `rungc run` does, and store every device of the model. They need the runtime library (`rungc book serve`)
t-executables-and-main-programs-take-modbus-tcp-mc-c74e0454 = 可执行文件和主程序与 `rungc run` 一样接受 --modbus-tcp、--mc 和 --fx，并保存机型的全部软元件。需要运行时库（`rungc book serve`）

# Exit code 0, whatever is missing
t-exit-code-0-whatever-is-missing-0d7e0d88 = 无论缺少什么，退出码均为 0

# Exit codes: 0: no difference; 1: a difference; 2: incorrect usage, or a program that cannot be read whole
t-exit-codes-0-no-difference-1-a-difference-6ff26e54 = 退出码：0：没有差异；1：有差异；2：用法错误，或程序不能完整读取

# Explain a diagnostic code, an instruction, a special device, an error code or a safety function, or print a page of the book
t-explain-a-diagnostic-code-an-instruction-a-special-854f781f = 说明诊断代码、指令、特殊软元件、错误代码或安全功能，或输出手册的一页

# Explain a moment of this recording, which `rungc watch --all --to csv` prints
t-explain-a-moment-of-this-recording-which-rungc-deeba28a = 说明此记录中的时刻，记录由 `rungc watch --all --to csv` 输出

# Explain the moment after this virtual time: `200ms`, `5s`, `2min`; a bare number is milliseconds. Default: 1s if a device is set, there is a machine, or `--how` asks; else the program alone is explained
t-explain-the-moment-after-this-virtual-time-200ms-8baf317a = 说明此虚拟时间之后的时刻：`200ms`、`5s`、`2min`；单独的数字为毫秒。默认：设置了软元件、有机器或使用 `--how` 时为 1s；否则只说明程序

# Explain why a device is on or off: which contacts, timers and states keep it so
t-explain-why-a-device-is-on-or-off-0ea45b2d = 说明软元件为何 ON 或 OFF：由哪些触点、定时器和状态保持

# Extra argument for cargo, such as `-Zbuild-std=core`; may be repeated
t-extra-argument-for-cargo-such-as-zbuild-std-7159de1a = 传给 cargo 的额外参数，如 `-Zbuild-std=core`；可重复给出

# Fail (exit code 1) on PLC operation errors; --verbose reports each as it occurs
t-fail-exit-code-1-on-plc-operation-errors-1867b14f = PLC 发生运算错误时失败（退出码 1）；--verbose 在每次发生时报告

# File to write the comparison to, overwriting an earlier one. Default: standard output
t-file-to-write-the-comparison-to-overwriting-an-421eed8a = 写入比较结果的文件，覆盖先前的结果。默认：标准输出

# File to write the results to, or those of --coverage or --mutants, overwriting earlier ones. Default: standard output
t-file-to-write-the-results-to-or-those-607ef6e1 = 写入结果或 --coverage、--mutants 的结果的文件，覆盖先前的结果。默认：标准输出

# File to write. Default: standard output
t-file-to-write-default-standard-output-81cb171a = 要写入的文件。默认：标准输出

# File to write. Default: standard output. With several programs, a folder for all outputs
t-file-to-write-default-standard-output-with-several-6e3ecbd2 = 要写入的文件。默认：标准输出。有多个程序时，为存放全部输出的文件夹

# File to write: the image, or the description. Default for --toml: standard output
t-file-to-write-the-image-or-the-description-6bfcb9b1 = 要写入的文件：映像或描述。--toml 默认为标准输出

# File to write; a table also as a workbook (.xlsx). Default: standard output. With several programs, a folder for all outputs
t-file-to-write-a-table-also-as-a-33669242 = 要写入的文件；表格也可为工作簿（.xlsx）。默认：标准输出。有多个程序时，为存放全部输出的文件夹

# Flash an image to a microcontroller through its ROM boot loader (STM32, AN3155) or with probe-rs
t-flash-an-image-to-a-microcontroller-through-its-ef0c9329 = 通过微控制器的 ROM 引导程序（STM32，AN3155）或 probe-rs 写入映像

# Folder (c, rust, lib) or file (bin, elf, fmu, ir) to write; for ir the default is standard output. With several programs, a folder for all outputs, each under its program's name; in c they share headers, the runtime and a Makefile there
t-folder-c-rust-lib-or-file-bin-elf-594632f5 = 要写入的文件夹（c、rust、lib）或文件（bin、elf、fmu、ir）；ir 默认为标准输出。有多个程序时，为存放全部输出的文件夹，各以其程序命名；c 形式共用其中的头文件、运行时和 Makefile

# Folder in which programs and test files may be written. A file that was there before is never replaced. Default: none
t-folder-in-which-programs-and-test-files-may-e71ecddc = 可以写入程序和测试文件的文件夹。原有的文件从不替换。默认：无

# Folder of the USB volume of an RP2040's boot ROM (Raspberry Pi Pico); `auto` searches for it
t-folder-of-the-usb-volume-of-an-rp2040-ee247d94 = RP2040（Raspberry Pi Pico）引导 ROM 的 USB 卷所在文件夹；`auto` 自动查找

# Folder outside that of rungc.toml which its `[build] output` may lead to; may be repeated
t-folder-outside-that-of-rungc-toml-which-its-2a4540dc = rungc.toml 的 `[build] output` 可以指向的、位于其文件夹之外的文件夹；可重复给出

# Folder outside that of rungc.toml which its `[io]` and `[retain]` may use; may be repeated
t-folder-outside-that-of-rungc-toml-which-its-6dadc5b9 = rungc.toml 的 `[io]` 和 `[retain]` 可以使用的、位于其文件夹之外的文件夹；可重复给出

# Folder to write the project to; no file of the project may exist there
t-folder-to-write-the-project-to-no-file-112d8e85 = 要写入项目的文件夹；其中不得已有项目的文件

# Folder whose files may be read, with those below it; links that lead out of it are not followed. May be repeated; paths begin at the first. Default: the current folder
t-folder-whose-files-may-be-read-with-those-5d0503f8 = 可以读取其中及以下文件的文件夹；不跟随指向其外的链接。可重复给出；路径从第一个开始。默认：当前文件夹

# Format instruction lists, preserving comments
t-format-instruction-lists-preserving-comments-35e7e20e = 整理指令表的格式，保留注释

# Format of diagnostics. Human-readable ones go to standard error, others to standard output, or to standard error if the command itself writes to standard output
t-format-of-diagnostics-human-readable-ones-go-to-e80fd360 = 诊断的格式。供人阅读的输出到标准错误，其他的输出到标准输出；如果命令本身写标准输出，则输出到标准错误

# Format of the comparison
t-format-of-the-comparison-73663f95 = 比较结果的格式

# Format of the results
t-format-of-the-results-a6edfcfa = 结果的格式

# Frame of the MC protocol: Ethernet modules of FX3 understand 1e; FX5, Q and L understand 3e
t-frame-of-the-mc-protocol-ethernet-modules-of-968e8666 = MC 协议的帧：FX3 的以太网模块使用 1e；FX5、Q 和 L 使用 3e

# GX Developer project (folder or MAIN.wpg) or GX Works2 project (.gxw)
t-gx-developer-project-folder-or-main-wpg-or-cc7d3ffa = GX Developer 项目（文件夹或 MAIN.wpg）或 GX Works2 项目（.gxw）

# Give each device with a comment a label that is its comment
t-give-each-device-with-a-comment-a-label-663dbf1c = 给每个有注释的软元件一个与注释相同的标号

# Human-readable
t-human-readable-41eb0545 = 供人阅读

# Human-readable: a line for each use
t-human-readable-a-line-for-each-use-c3c6195f = 供人阅读：每次使用一行

# Human-readable: failed cases and totals
t-human-readable-failed-cases-and-totals-2e25cf19 = 供人阅读：失败的用例和合计

# Human-readable: the lines of ladder that differ
t-human-readable-the-lines-of-ladder-that-differ-df2b0af9 = 供人阅读：梯形图中不同的行

# Human-readable: whatever was not reached, line by line
t-human-readable-whatever-was-not-reached-line-by-aeec5ca4 = 供人阅读：逐行列出未达到的部分

# Ignore cached results: also run cases that passed before with the same files and compiler
t-ignore-cached-results-also-run-cases-that-passed-f2afb1c4 = 忽略缓存的结果：先前以相同文件和编译器通过的用例也运行

# Image to write: an ELF file of `rungc build --emit elf`, UF2 for `--volume`, or a raw binary
t-image-to-write-an-elf-file-of-rungc-a5615e5f = 要写入的映像：`rungc build --emit elf` 的 ELF 文件、用于 `--volume` 的 UF2，或原始二进制文件

# In an instruction list, the device is replaced in all operands and in its comment, or, with the reason, not at all. A name that is not a device becomes its label in rungc.toml, for programs of any format. Exit codes: 0: renamed; 1: a program with errors; 2: incorrect usage, or a name that the device cannot have
t-in-an-instruction-list-the-device-is-replaced-47debf54 = 在指令表中，替换所有操作数和注释中的该软元件；不能替换时说明原因并保持不变。不是软元件的名称将成为 rungc.toml 中的标号，适用于任何格式的程序。退出码：0：已更名；1：程序有错误；2：用法错误，或该软元件不能使用此名称

# In the human format, draw the network of each diagnostic as a ladder diagram, with the place marked
t-in-the-human-format-draw-the-network-of-db76cc33 = 在供人阅读的格式中，把每个诊断所在的网络画成梯形图并标出位置

# Input format, if it cannot be detected
t-input-format-if-it-cannot-be-detected-7391b184 = 输入格式，用于无法自动识别时

# Instruction list
t-instruction-list-afb462e9 = 指令表

# Instruction list of IEC 61131-3
t-instruction-list-of-iec-61131-3-d1bb2725 = IEC 61131-3 的指令表

# Instruction list, structured text (.st), list export (CSV), GX Developer project (folder or MAIN.wpg), GX Works2 project (.gxw) or image of program memory; recognised by content, not by name. `-` is standard input. Default: the program of rungc.toml
t-instruction-list-structured-text-st-list-export-csv-2e5acbd5 = 指令表、结构化文本（.st）、列表导出文件（CSV）、GX Developer 项目（文件夹或 MAIN.wpg）、GX Works2 项目（.gxw）或程序存储器映像；按内容而不是按名称识别。`-` 为标准输入。默认：rungc.toml 中的程序

# Instruction lists, structured text (.st), list exports (CSV), GX Developer projects (folder or MAIN.wpg), GX Works2 projects (.gxw), PLCopen XML and images of program memory, recognised by content, not by name; folders, for all programs in them and below (lists and drawn ladder as `.il`); `-` is standard input. Default: the program of rungc.toml
t-instruction-lists-structured-text-st-list-exports-csv-1b1790aa = 指令表、结构化文本（.st）、列表导出文件（CSV）、GX Developer 项目（文件夹或 MAIN.wpg）、GX Works2 项目（.gxw）、PLCopen XML 和程序存储器映像，按内容而不是按名称识别；文件夹表示其中及以下的所有程序（列表和 `.il` 形式的梯形图）；`-` 为标准输入。默认：rungc.toml 中的程序

# JSON: one object
t-json-one-object-a19fc3ce = JSON：一个对象

# JSON: one object (`rungc book diff`)
t-json-one-object-rungc-book-diff-5ddcf342 = JSON：一个对象（`rungc book diff`）

# JSON: one object (`rungc book test-files`)
t-json-one-object-rungc-book-test-files-30712eff = JSON：一个对象（`rungc book test-files`）

# JSON: one object, with a member of `programs` for each program
t-json-one-object-with-a-member-of-programs-0b0a00f7 = JSON：一个对象，`programs` 中每个程序一个成员

# JUnit XML, for continuous integration
t-junit-xml-for-continuous-integration-b4fe966a = JUnit XML，用于持续集成

# JUnit XML: errors as cases that failed; of `verify`, a case for each property or output
t-junit-xml-errors-as-cases-that-failed-of-c0f49fa1 = JUnit XML：错误作为失败的用例；`verify` 的每个性质或输出为一个用例

# Label tables of a GX Works2 project as it reads them from CSV, into a folder
t-label-tables-of-a-gx-works2-project-as-505ac3c5 = GX Works2 项目的标号表，采用其 CSV 导入格式，写入文件夹

# Ladder
t-ladder-467435c9 = 梯形图

# Ladder diagram drawn in characters
t-ladder-diagram-drawn-in-characters-d36c2bb5 = 用字符画的梯形图

# Lanes from 1,000,000 scans on, if the program allows them and `cc` is installed
t-lanes-from-1-000-000-scans-on-if-a46f4503 = 从 1,000,000 次扫描起使用多通道，前提是程序允许且已安装 `cc`

# Language of diagnostics and their explanations: en or zh. Default: that of rungc.toml, else of the environment
t-language-of-diagnostics-and-their-explanations-en-or-105f6877 = 诊断及其说明的语言：en 或 zh。默认：rungc.toml 中的语言，否则为环境的语言

# Language of the body in PLCopen XML. Default: `ld`
t-language-of-the-body-in-plcopen-xml-default-83c7adcd = PLCopen XML 中程序体的语言。默认：`ld`

# Language of the image's sources
t-language-of-the-image-s-sources-9853b62e = 映像源程序的语言

# Latched devices start at 0, as in a new PLC. Default: at any value
t-latched-devices-start-at-0-as-in-a-29dc65fa = 停电保持的软元件从 0 开始，如同新的 PLC。默认：从任意值开始

# Learn unknown instruction codes of a vendor project from the editor's list export
t-learn-unknown-instruction-codes-of-a-vendor-project-b1290c6c = 从编辑器的列表导出文件学习厂商项目中未知的指令代码

# Limit of the effort per property, in steps of the search; 1000 are about a second. What is found does not depend on the machine or its load. Default: that of rungc.toml, else 10000, or no limit with a time limit
t-limit-of-the-effort-per-property-in-steps-56164efa = 每个性质的工作量上限，以搜索步数计；1000 约为一秒。所得结果不取决于机器或其负载。默认：rungc.toml 中的上限，否则为 10000；有时间限制时没有上限

# Line width in characters. Default: the width of the terminal, or 120; 104 in pages and pictures
t-line-width-in-characters-default-the-width-of-52515efb = 行宽，以字符计。默认：终端的宽度或 120；页面和图中为 104

# Line width of ladder diagrams, in characters. Default: the width of the terminal, or 120; 100 with `--format md`
t-line-width-of-ladder-diagrams-in-characters-default-7228e329 = 梯形图的行宽，以字符计。默认：终端的宽度或 120；`--format md` 时为 100

# List export (CSV) of the same state of the project
t-list-export-csv-of-the-same-state-of-b43c734a = 同一状态的项目的列表导出文件（CSV）

# List only these devices: `M100`, `D100..D199` or a comment; may be repeated or separated by commas
t-list-only-these-devices-m100-d100-d199-or-1bf0f274 = 只列出这些软元件：`M100`、`D100..D199` 或注释；可重复给出或用逗号分隔

# List the instructions that read, write, set and reset each device
t-list-the-instructions-that-read-write-set-and-42a6b6fa = 列出读取、写入、置位和复位各软元件的指令

# List the pages of the book, or print one
t-list-the-pages-of-the-book-or-print-e28efde7 = 列出手册的页面，或输出其中一页

# List the supported boards, or show the pins of one
t-list-the-supported-boards-or-show-the-pins-084dd80f = 列出支持的电路板，或显示其中一块的引脚

# List the tools that rungc calls, the serial ports and settings of this machine, and what each missing one prevents
t-list-the-tools-that-rungc-calls-the-serial-746252c2 = 列出 rungc 调用的工具、本机的串口和设置，以及缺少的每一项妨碍什么

# Lists of AutoShop's windows, each with its heading (`MAIN`, `SBR name`, `INT name I001`)
t-lists-of-autoshop-s-windows-each-with-its-729002f2 = AutoShop 各窗口的列表，各带标题（`MAIN`、`SBR name`、`INT name I001`）

# Lists what will be erased, and asks for confirmation. Exit codes: 0: written and verified; 1: failed because of the boot loader, the part or the line (E0850 and following); 2: incorrect usage or unreadable image; 130: interrupted
t-lists-what-will-be-erased-and-asks-for-ba394d96 = 列出将被擦除的内容，并请求确认。退出码：0：已写入并校验；1：因引导程序、器件或线路而失败（E0850 及以后）；2：用法错误或映像不可读；130：被中断

# Log each frame, decoded and as bytes: to standard error, or to a file, overwriting an earlier log; to `*.pcap` or `*.pcapng` as a capture for Wireshark (`rungc book serve`)
t-log-each-frame-decoded-and-as-bytes-to-3221d1d5 = 记录每一帧，解码并附字节：输出到标准错误，或写入文件并覆盖先前的记录；写入 `*.pcap` 或 `*.pcapng` 时为 Wireshark 的捕获文件（`rungc book serve`）

# Look once
t-look-once-e353bdf7 = 只查看一次

# Make emitted Rust depend on the runtime in this folder, which several crates can share, instead of a copy inside the crate; the runtime is written there unless the folder has it (`rungc book embedding`)
t-make-emitted-rust-depend-on-the-runtime-in-8da07662 = 使生成的 Rust 依赖此文件夹中的运行时（可由多个 crate 共用），而不是 crate 内的副本；文件夹中没有时写入运行时（`rungc book embedding`）

# Make the page read-only: it shows the run, and accepts no commands
t-make-the-page-read-only-it-shows-the-9e3bf544 = 使页面只读：只显示运行，不接受命令

# Markdown, for a comment on a pull request
t-markdown-for-a-comment-on-a-pull-request-be0e9035 = Markdown，用于合并请求的评论

# Maximum number of diagnostics to print in the human format; 0 prints all
t-maximum-number-of-diagnostics-to-print-in-the-bbe7113b = 供人阅读的格式中最多输出的诊断数；0 表示全部

# Maximum time between scans. Default: that of rungc.toml, or 200ms
t-maximum-time-between-scans-default-that-of-rungc-7027a8f7 = 两次扫描之间的最长时间。默认：rungc.toml 中的时间，或 200ms

# Name of the program in the emitted code. Default: derived from the file's name
t-name-of-the-program-in-the-emitted-code-afc3a815 = 生成代码中程序的名称。默认：由文件名得出

# Never
t-never-b2ff2b29 = 从不

# New device, or a label
t-new-device-or-a-label-3c3018c5 = 新软元件，或标号

# No parity, 1 stop bit
t-no-parity-1-stop-bit-21078341 = 无校验，1 个停止位

# No parity, 2 stop bits
t-no-parity-2-stop-bits-9f8d06b7 = 无校验，2 个停止位

# Number of retries if a response is missing or damaged
t-number-of-retries-if-a-response-is-missing-dc0b3e2a = 响应缺失或损坏时的重试次数

# Number of scans to execute; a round of the search that has begun is completed
t-number-of-scans-to-execute-a-round-of-bf1e5dfc = 要执行的扫描次数；已开始的一轮搜索会完成

# Number of the Modbus slave
t-number-of-the-modbus-slave-a1c4c88b = Modbus 从站号

# Number of threads. Default: one per processor. Does not affect the results
t-number-of-threads-default-one-per-processor-does-22fd3a4a = 线程数。默认：每个处理器一个。不影响结果

# Odd parity
t-odd-parity-f6c99d03 = 奇校验

# Offers tools that read, check, run, test and prove programs, pages of the book, and prompts. Assistants start this command (`rungc book assistants`) and talk to it on standard input and output. It reads files below its folders, writes none unless `--allow-write` names a folder for that, and opens no connection. Exit codes: 0: the client has closed the input; 2: incorrect usage, or output that cannot be written
t-offers-tools-that-read-check-run-test-and-41c47b59 = 提供读取、检查、运行、测试和证明程序的工具、手册页面和提示词。助手启动此命令（`rungc book assistants`），并通过标准输入和输出与其通信。它读取所给文件夹之下的文件，除非用 `--allow-write` 指定文件夹，否则不写入任何文件，也不打开任何连接。退出码：0：客户端已关闭输入；2：用法错误，或输出无法写入

# Omit device comments, in the terminal
t-omit-device-comments-in-the-terminal-d1ac8e3c = 在终端中省略软元件注释

# On a terminal, unless NO_COLOR is set
t-on-a-terminal-unless-no-color-is-set-2c6e204a = 在终端上使用，除非设置了 NO_COLOR

# One page with links into the ladder, for whoever inherits the machine, in the language of the reports
t-one-page-with-links-into-the-ladder-for-85cfc254 = 一个带有梯形图链接的页面，供接手机器的人使用，语言与报告相同

# Operation errors (M8067)
t-operation-errors-m8067-13ced932 = 运算错误（M8067）

# Options
t-options-353e0d45 = 选项

# Options add servers to those of rungc.toml, and take precedence for a protocol or serial port that both name. At the end, a table lists the connections: frames, errors, and devices written
t-options-add-servers-to-those-of-rungc-toml-faf23106 = 选项在 rungc.toml 的服务器之外再增加服务器；两者都指定的协议或串口以选项为准。结束时用表格列出各连接：帧数、错误数和被写入的软元件

# Output file for the verdicts, in the format of --format; overwrites earlier ones. Default: standard output
t-output-file-for-the-verdicts-in-the-format-30fbf660 = 写入判定结果的文件，采用 --format 的格式；覆盖先前的结果。默认：标准输出

# Output form
t-output-form-bd67926a = 输出形式

# Output format
t-output-format-a529df3f = 输出格式

# Output format; `image` is the unchanged program memory
t-output-format-image-is-the-unchanged-program-memory-98d80a32 = 输出格式；`image` 为未改变的程序存储器内容

# Outputs that change in every scan
t-outputs-that-change-in-every-scan-aa048263 = 每次扫描都变化的输出

# Outputs that two coils drive to different values in one scan
t-outputs-that-two-coils-drive-to-different-values-4fc131f6 = 同一扫描中被两个线圈驱动为不同值的输出

# Overwrite an existing backup
t-overwrite-an-existing-backup-b275820c = 覆盖已有的备份

# Overwrite an existing file
t-overwrite-an-existing-file-cc1cf91c = 覆盖已有的文件

# Overwrite an existing file that is not an earlier comparison
t-overwrite-an-existing-file-that-is-not-an-5e8ec65a = 覆盖不是先前比较结果的已有文件

# Overwrite an existing file that is not an earlier result
t-overwrite-an-existing-file-that-is-not-an-5c187fe2 = 覆盖不是先前结果的已有文件

# Overwrite existing files
t-overwrite-existing-files-837b4c70 = 覆盖已有文件

# Overwrite existing files that are not earlier results of the same kind
t-overwrite-existing-files-that-are-not-earlier-results-c4c53be2 = 覆盖不是同类先前结果的已有文件

# PLC model whose instructions, special devices and error codes are shown. Default: all
t-plc-model-whose-instructions-special-devices-and-error-a0857b1e = 要显示其指令、特殊软元件和错误代码的 PLC 机型。默认：全部

# PLC model. Default: that of rungc.toml, else the CPU type that the file names, else fx3u. `rungc explain h2u-mtq` shows a variant
t-plc-model-default-that-of-rungc-toml-else-f93390a2 = PLC 机型。默认：rungc.toml 中的机型，否则为文件所注明的 CPU 类型，否则为 fx3u。`rungc explain h2u-mtq` 显示一个变型

# PLC model. Default: that of the settings, else the CPU type that the project names
t-plc-model-default-that-of-the-settings-else-636a9a89 = PLC 机型。默认：设置中的机型，否则为项目所注明的 CPU 类型

# PLCopen XML project (TC6 2.01)
t-plcopen-xml-project-tc6-2-01-b7ec36e9 = PLCopen XML 项目（TC6 2.01）

# Page to print, as the list names it: `serve`, `test-files`. Default: list all pages
t-page-to-print-as-the-list-names-it-f6fc2c0f = 要输出的页面，按列表中的名称：`serve`、`test-files`。默认：列出所有页面

# Page to write (.html), which a browser prints, or the same as data (.json)
t-page-to-write-html-which-a-browser-prints-3c0235cb = 要写入的页面（.html，可由浏览器打印），或同样内容的数据（.json）

# Parity and stop bits of the serial line to the Modbus slave
t-parity-and-stop-bits-of-the-serial-line-6d6d5f9c = 到 Modbus 从站的串行线路的校验和停止位

# Possible values
t-possible-values-bc143884 = 可选值

# Print a completion script for a shell
t-print-a-completion-script-for-a-shell-3604fa6c = 输出 shell 的补全脚本

# Print help (see a summary with '-h')
t-print-help-see-a-summary-with-h-d04996c7 = 显示帮助（`-h` 为摘要）

# Print help (see more with '--help')
t-print-help-see-more-with-help-0a4f0559 = 显示帮助（`--help` 更详细）

# Print more details
t-print-more-details-eca39a6b = 输出更多细节

# Print only diagnostics and results, no progress
t-print-only-diagnostics-and-results-no-progress-3004e941 = 只输出诊断和结果，不输出进度

# Print the description as TOML, as a template for your own board
t-print-the-description-as-toml-as-a-template-51adfa2a = 以 TOML 输出描述，作为自己的电路板的模板

# Print the manual page of rungc, or of one of its commands
t-print-the-manual-page-of-rungc-or-of-88b2c2d9 = 输出 rungc 或其某个命令的 man 页

# Print this message or the help of the given subcommand(s)
t-print-this-message-or-the-help-of-the-7623c860 = 显示本帮助或所给命令的帮助

# Print version
t-print-version-070bbb84 = 显示版本

# Print what an assistant, or a person in a hurry, must know of the language and of rungc
t-print-what-an-assistant-or-a-person-in-8f8bb23b = 输出助手或时间紧迫的人需要了解的语言和 rungc 要点

# Program memory of an FX PLC
t-program-memory-of-an-fx-plc-62908f11 = FX PLC 的程序存储器

# Prove that a program has a property, or show how it violates it
t-prove-that-a-program-has-a-property-or-b2083b0e = 证明程序具有某性质，或给出违反该性质的过程

# Put another device in the place of one, or give devices labels
t-put-another-device-in-the-place-of-one-51c9c1a1 = 用另一个软元件替换某软元件，或给软元件命名标号

# Put only sources into a functional mock-up unit, no shared library for this machine or --target (`rungc book fmu`)
t-put-only-sources-into-a-functional-mock-up-de068e72 = 功能样机单元中只放源程序，不含供本机或 --target 使用的共享库（`rungc book fmu`）

# Random seed: another seed searches differently
t-random-seed-another-seed-searches-differently-b18d181d = 随机种子：不同的种子有不同的搜索

# Read a PLC that is a Modbus slave: by Modbus TCP at `HOST:PORT`, by RTU at a serial port (`/dev/ttyUSB0`, `COM3`) or at a serial device server (`tcp:HOST:PORT`)
t-read-a-plc-that-is-a-modbus-slave-ddef5f5b = 读取作为 Modbus 从站的 PLC：`HOST:PORT` 为 Modbus TCP；串口（`/dev/ttyUSB0`、`COM3`）或串口设备服务器（`tcp:HOST:PORT`）为 RTU

# Read a PLC that speaks the MC protocol over TCP, in binary, such as an FX3U with an Ethernet module
t-read-a-plc-that-speaks-the-mc-protocol-4bd4c2e9 = 读取使用 TCP 上的 MC 协议（二进制）的 PLC，例如带以太网模块的 FX3U

# Read the PLC whose programming port is at this serial port (`/dev/ttyUSB0`, `COM3`) or at a serial device server (`tcp:HOST:PORT`)
t-read-the-plc-whose-programming-port-is-at-f9f6b0bd = 读取编程口位于此串口（`/dev/ttyUSB0`、`COM3`）或串口设备服务器（`tcp:HOST:PORT`）的 PLC

# Read the compiled program of a GX Works2 project, not its source
t-read-the-compiled-program-of-a-gx-works2-ca4fa0e1 = 读取 GX Works2 项目的已编译程序，而不是其源程序

# Read the program from a PLC over its programming port
t-read-the-program-from-a-plc-over-its-a6972e6c = 通过编程口从 PLC 读取程序

# Record inputs, outputs and watched devices as a value change dump for GTKWave and other waveform viewers; overwrites an earlier recording
t-record-inputs-outputs-and-watched-devices-as-a-e2370415 = 把输入、输出和所显示的软元件记录为 VCD 波形文件，供 GTKWave 等波形查看器使用；覆盖先前的记录

# Record the run of the first finding as a value change dump; overwrites an earlier one
t-record-the-run-of-the-first-finding-as-e93eac4f = 把第一个发现的运行过程记录为 VCD 波形文件；覆盖先前的文件

# Record this run as a test file (`*.plctest.toml`): the devices set, and the outputs and the devices of --watch as expectations
t-record-this-run-as-a-test-file-plctest-9a34fbd6 = 把本次运行记录为测试文件（`*.plctest.toml`）：所设置的软元件，以及作为期望值的输出和 --watch 的软元件

# Remove read and write protection. Removing read protection erases all of flash permanently
t-remove-read-and-write-protection-removing-read-protection-af3f4e7c = 解除读保护和写保护。解除读保护会永久擦除整个闪存

# Report coverage: networks, decisive contacts, coils on and off, transitions, timers (`rungc book coverage`). All cases run in the interpreter
t-report-coverage-networks-decisive-contacts-coils-on-and-94a15caa = 报告覆盖率：网络、起决定作用的触点、线圈的 ON 和 OFF、转移、定时器（`rungc book coverage`）。所有用例在解释器中运行

# Report resource usage on the target, built from C: flash, RAM, stack, steps of the longest scan (`rungc book report`)
t-report-resource-usage-on-the-target-built-from-eaaba3df = 报告在目标机上的资源占用（由 C 编译）：闪存、RAM、栈、最长扫描的步数（`rungc book report`）

# Report surviving mutants: small changes to the programs that no case detects (`rungc book mutants`)
t-report-surviving-mutants-small-changes-to-the-programs-ac5a9bba = 报告存活的变异体：没有用例能发现的程序小改动（`rungc book mutants`）

# Rerun whenever a test file, program, machine, trace or setting is saved, until Ctrl-C
t-rerun-whenever-a-test-file-program-machine-trace-2c78f145 = 每当测试文件、程序、机器、轨迹或设置保存时重新运行，直到 Ctrl-C

# Run PLC test files on one or all engines
t-run-plc-test-files-on-one-or-all-bf0e0550 = 在一个或全部引擎上运行 PLC 测试文件

# Run a program in real time with the servers and serial lines of `[serve]` in rungc.toml, until Ctrl-C
t-run-a-program-in-real-time-with-the-e81b07cf = 以实际时间运行程序，并按 rungc.toml 中的 `[serve]` 提供服务器和串行线路，直到 Ctrl-C

# Run a program in the interpreter with virtual time
t-run-a-program-in-the-interpreter-with-virtual-cad11be1 = 在解释器中以虚拟时间运行程序

# Run in real time instead of as fast as possible
t-run-in-real-time-instead-of-as-fast-b56338a6 = 以实际时间运行，而不是尽快运行

# Run in virtual time, as fast as the machine can
t-run-in-virtual-time-as-fast-as-the-69efd071 = 以虚拟时间运行，尽本机所能

# Run many PLCs in lock step, each with its own ports or MQTT topics, until Ctrl-C
t-run-many-plcs-in-lock-step-each-with-a576effe = 以相同节拍运行多台 PLC，各有自己的端口或 MQTT 主题，直到 Ctrl-C

# Run only cases whose `file::name` contains this
t-run-only-cases-whose-file-name-contains-this-db737bbb = 只运行 `file::name` 中含有此文本的用例

# Run only one part of the cases (with --mutants, of the mutants), to share the work between machines: `1/4` is the first of four. The part of a case depends on its name alone
t-run-only-one-part-of-the-cases-with-1f835cbd = 只运行一部分用例（使用 --mutants 时为变异体），以便多台机器分担：`1/4` 为四份中的第一份。用例属于哪一份只取决于其名称

# Run time of a simulator image, after which it exits: `30s`
t-run-time-of-a-simulator-image-after-which-82a33739 = 模拟器映像的运行时间，到时退出：`30s`

# Rust: the board's pins only, no C functions
t-rust-the-board-s-pins-only-no-c-de372803 = Rust：只有电路板的引脚，没有 C 函数

# SARIF 2.1.0
t-sarif-2-1-0-293ed29b = SARIF 2.1.0

# SARIF 2.1.0: failed cases with their places, for code scanning services
t-sarif-2-1-0-failed-cases-with-their-a1b3e9b4 = SARIF 2.1.0：失败的用例及其位置，用于代码扫描服务

# Save all of flash to a file before erasing. Not possible for a read-protected part
t-save-all-of-flash-to-a-file-before-7656d0f2 = 擦除之前把整个闪存保存到文件。读保护的器件不能

# Scan time, in virtual time; a longer constant scan time of the program takes precedence. Default: the program's constant scan time, or 10ms
t-scan-time-in-virtual-time-a-longer-constant-9573c1a9 = 以虚拟时间计的扫描时间；程序的恒定扫描时间更长时以其为准。默认：程序的恒定扫描时间，或 10ms

# Scan with this real-time priority (Linux: SCHED_FIFO, 1 to 99), with all memory locked. If the system does not permit this, a warning is printed and the fleet runs without
t-scan-with-this-real-time-priority-linux-sched-b8f9a242 = 以此实时优先级扫描（Linux：SCHED_FIFO，1 至 99），并锁定全部内存。系统不允许时给出警告，机群照常运行

# Scan with this real-time priority (Linux: SCHED_FIFO, 1 to 99), with all memory locked. If the system does not permit this, a warning is printed and the run continues without. At the end, scan start latency is reported
t-scan-with-this-real-time-priority-linux-sched-08b1032a = 以此实时优先级扫描（Linux：SCHED_FIFO，1 至 99），并锁定全部内存。系统不允许时给出警告，运行照常。结束时报告扫描开始的延迟

# Scripted inputs for simulator images: `X000=1@2s`; may be repeated or separated by commas
t-scripted-inputs-for-simulator-images-x000-1-2s-709a20d0 = 模拟器映像的脚本输入：`X000=1@2s`；可重复给出或用逗号分隔

# Search for runs with property violations, operation errors, or coils that drive an output to conflicting states
t-search-for-runs-with-property-violations-operation-errors-8dd21488 = 搜索违反性质、发生运算错误或线圈对同一输出给出矛盾状态的运行过程

# Search for what a person can do from that moment on so that the device changes
t-search-for-what-a-person-can-do-from-2321c462 = 搜索从该时刻起人可以做什么，使软元件发生变化

# Sequential function chart of a step ladder (STL) program
t-sequential-function-chart-of-a-step-ladder-stl-92771dfe = 步进梯形图（STL）程序的顺序功能图

# Serial port connected to the PLC's programming port (`/dev/ttyUSB0`, `COM3`), or a serial device server (`tcp:HOST:PORT`)
t-serial-port-connected-to-the-plc-s-programming-07443163 = 连接到 PLC 编程口的串口（`/dev/ttyUSB0`、`COM3`），或串口设备服务器（`tcp:HOST:PORT`）

# Serial port connected to the boot loader's UART (`/dev/ttyUSB0`, `COM3`), or a serial device server (`tcp:HOST:PORT`). The line has 8 data bits and even parity
t-serial-port-connected-to-the-boot-loader-s-2acfba08 = 连接到引导程序 UART 的串口（`/dev/ttyUSB0`、`COM3`），或串口设备服务器（`tcp:HOST:PORT`）。线路为 8 个数据位、偶校验

# Serve a page that shows the ladder live and controls the run, at this port on this machine only; default: a free port. Prints the address to open in a browser (`rungc book live`). Runs in real time
t-serve-a-page-that-shows-the-ladder-live-1e6be1c8 = 在仅限本机的此端口提供实时显示梯形图并控制运行的页面；默认：空闲端口。输出在浏览器中打开的地址（`rungc book live`）。以实际时间运行

# Serve all devices over Modbus TCP at this address: `127.0.0.1:5020`, or a port on this machine only (`5020`). Runs in real time. The protocol has no authentication: anyone who can reach the address can read and write every device
t-serve-all-devices-over-modbus-tcp-at-this-cf0a01fa = 在此地址通过 Modbus TCP 提供全部软元件：`127.0.0.1:5020`，或仅限本机的端口（`5020`）。以实际时间运行。该协议没有身份验证：任何能到达该地址的人都能读写每个软元件

# Serve all devices over the MC protocol (1E and 3E frames, binary and ASCII), as --modbus-tcp does
t-serve-all-devices-over-the-mc-protocol-1e-5eaa6519 = 通过 MC 协议（1E 和 3E 帧，二进制和 ASCII）提供全部软元件，方式同 --modbus-tcp

# Serve all devices over the programming port's protocol, as --modbus-tcp does; or connect the programming port to a line, as with --serial: `--fx pty`, `--fx /dev/ttyUSB0`
t-serve-all-devices-over-the-programming-port-s-89a0beda = 通过编程口协议提供全部软元件，方式同 --modbus-tcp；或把编程口连接到线路，方式同 --serial：`--fx pty`、`--fx /dev/ttyUSB0`

# Serve an assistant over the Model Context Protocol
t-serve-an-assistant-over-the-model-context-protocol-b0075a8a = 通过模型上下文协议（MCP）为助手服务

# Serve an editor over the Language Server Protocol
t-serve-an-editor-over-the-language-server-protocol-5400fb00 = 通过语言服务器协议（LSP）为编辑器服务

# Set a device at a time, as for `rungc run`: `X000=1@200ms`; may be repeated or separated by commas
t-set-a-device-at-a-time-as-for-7d57f0c4 = 在某时刻设置软元件，同 `rungc run`：`X000=1@200ms`；可重复给出或用逗号分隔

# Set a device at a time: `X000=1@200ms`, `D0=5` (at the start), `D0.f32=1.5`, `D1=H1F`, `Start button=1`; may be repeated or separated by commas. A comment with a comma may stand in quotes: `"Speed, set"=5`
t-set-a-device-at-a-time-x000-1-c133cb23 = 在某时刻设置软元件：`X000=1@200ms`、`D0=5`（开始时）、`D0.f32=1.5`、`D1=H1F`、`Start button=1`；可重复给出或用逗号分隔。带逗号的注释可用引号括起：`"Speed, set"=5`

# Settings file to write the codes to. Default: the nearest rungc.toml, in the project's folder or above it, else a new one in that folder
t-settings-file-to-write-the-codes-to-default-c9b2b19f = 要写入代码的设置文件。默认：项目所在文件夹或其上级中最近的 rungc.toml，否则为该文件夹中的新文件

# Settings of the project (`rungc book project`). Default: the nearest rungc.toml, in each program's folder or above it
t-settings-of-the-project-rungc-book-project-default-dc75157f = 项目的设置（`rungc book project`）。默认：各程序所在文件夹或其上级中最近的 rungc.toml

# Settings of the project (`rungc book project`). Default: the rungc.toml in this folder or the nearest one above
t-settings-of-the-project-rungc-book-project-default-a0f814ba = 项目的设置（`rungc book project`）。默认：此文件夹或其上级中最近的 rungc.toml

# Show all devices that the program names, and whether the PLC is in RUN (M8000)
t-show-all-devices-that-the-program-names-and-3a6c3ccc = 显示程序使用的全部软元件，以及 PLC 是否处于 RUN（M8000）

# Show each trace that differs from the accepted one, and prompt to accept it
t-show-each-trace-that-differs-from-the-accepted-fbb1967f = 显示每个与已接受轨迹不同的轨迹，并询问是否接受

# Show the devices of a PLC as they change, by its programming port, MC protocol or Modbus
t-show-the-devices-of-a-plc-as-they-5bfafc49 = 通过编程口、MC 协议或 Modbus 显示 PLC 软元件的变化

# Shows diagnostics, fixes, explanations and the ways through a program while you type. Editors start this command (`rungc book editors`) and talk to it on standard input and output. Exit codes: 0: shut down by the editor; 1: the connection ended without that
t-shows-diagnostics-fixes-explanations-and-the-ways-through-d28aafd2 = 在输入时显示诊断、修复、说明和程序中的跳转。编辑器启动此命令（`rungc book editors`），并通过标准输入和输出与其通信。退出码：0：由编辑器关闭；1：连接未经关闭而结束

# Simulated machine (`rungc book machines`) for cases that do not specify one
t-simulated-machine-rungc-book-machines-for-cases-that-9fc250bf = 模拟的机器（`rungc book machines`），用于未指定机器的用例

# Simulated machine, whose axes, cylinders and delays follow the outputs and drive inputs (`rungc book machines`)
t-simulated-machine-whose-axes-cylinders-and-delays-follow-7fd97948 = 模拟的机器，其轴、气缸和延时跟随输出并驱动输入（`rungc book machines`）

# Sources of a GX Works2 project, a text for each POU, structure and table of global labels, into a folder
t-sources-of-a-gx-works2-project-a-text-d697b35d = GX Works2 项目的源程序，每个 POU、结构体和全局标号表一个文本，写入文件夹

# Start the program afterwards. Its outputs switch immediately
t-start-the-program-afterwards-its-outputs-switch-immediately-6c3fae89 = 之后启动程序。其输出立即动作

# Stop after this time. Default: Ctrl-C
t-stop-after-this-time-default-ctrl-c-7ad10712 = 在此时间之后停止。默认：Ctrl-C

# Stop at the first finding
t-stop-at-the-first-finding-dd1aaf22 = 有第一个发现时停止

# Store latched devices in this file: loaded at the start, saved at the end, and in real time also once a second if one has changed. Default: the file named in rungc.toml
t-store-latched-devices-in-this-file-loaded-at-956d8c4e = 把停电保持的软元件保存在此文件：开始时读入，结束时保存；实际时间运行时，若有变化则每秒保存一次。默认：rungc.toml 指定的文件

# Suppress warnings and notes with this code (W0203) or name (double-coil); may be repeated or separated by commas
t-suppress-warnings-and-notes-with-this-code-w0203-f14975bd = 抑制具有此代码（W0203）或名称（double-coil）的警告和提示；可重复给出或用逗号分隔

# Target: `host` or a Rust target triple such as thumbv7em-none-eabihf. Images use the board's target
t-target-host-or-a-rust-target-triple-such-5eb24981 = 目标：`host` 或 Rust 目标三元组，如 thumbv7em-none-eabihf。映像使用电路板的目标

# Test files (`*.plctest.toml`), or folders of them. Default: those of rungc.toml
t-test-files-plctest-toml-or-folders-of-them-fb3ea693 = 测试文件（`*.plctest.toml`），或其所在文件夹。默认：rungc.toml 中的测试文件

# Text encoding, such as windows-1252, gbk or shift_jis. Default: the encoding that a project states, else the most likely one
t-text-encoding-such-as-windows-1252-gbk-or-c2f0579b = 文本编码，如 windows-1252、gbk 或 shift_jis。默认：项目注明的编码，否则为最可能的编码

# The PLC is read, and nothing in it is changed
t-the-plc-is-read-and-nothing-in-it-23164fd5 = 只读取 PLC，不改变其中任何内容

# The PLC keeps running, and nothing in it changes. Programs protected by a keyword are not read
t-the-plc-keeps-running-and-nothing-in-it-b8568e0e = PLC 继续运行，其中内容不变。有关键字保护的程序不读取

# The editors' list export (UTF-16, tabs)
t-the-editors-list-export-utf-16-tabs-deb38255 = 编辑器的列表导出文件（UTF-16，制表符分隔）

# The intermediate representation, as text
t-the-intermediate-representation-as-text-4bcf4b29 = 文本形式的中间表示

# The interpreter
t-the-interpreter-1025b632 = 解释器

# The old program and the new one, of any kind that `check` reads; `-` is standard input. With seven or nine arguments, those with which Git calls a diff driver (`rungc book diff`)
t-the-old-program-and-the-new-one-of-942bfd66 = 旧程序和新程序，可为 `check` 能读取的任何格式；`-` 为标准输入。参数为七个或九个时，是 Git 调用 diff 驱动程序的参数（`rungc book diff`）

# The program
t-the-program-43c317a0 = 程序

# The program of the project; both files are written to its folder. Default: the only program in this folder
t-the-program-of-the-project-both-files-are-d98874a9 = 项目的程序；两个文件都写入其文件夹。默认：此文件夹中唯一的程序

# The program runs in virtual time; the editor stops it at instructions, device changes and errors, and goes back in time. Editors start this command (`rungc book debugging`) and talk to it on standard input and output. Exit codes: 0: disconnected by the editor; 1: the connection ended without that
t-the-program-runs-in-virtual-time-the-editor-db67c136 = 程序以虚拟时间运行；编辑器可使其停在指令、软元件变化和错误处，并可倒回。编辑器启动此命令（`rungc book debugging`），并通过标准输入和输出与其通信。退出码：0：由编辑器断开；1：连接未经断开而结束

# The reference interpreter
t-the-reference-interpreter-b0612f2f = 参考解释器

# The same as `--to json`: its name in earlier versions
t-the-same-as-to-json-its-name-in-ffe62594 = 与 `--to json` 相同：早期版本中的名称

# The same in seconds: its name in earlier versions
t-the-same-in-seconds-its-name-in-earlier-67311193 = 同上，以秒计：早期版本中的名称

# The shell
t-the-shell-205d79c6 = shell 的名称

# Time between the beginnings of two looks; a slow line takes longer
t-time-between-the-beginnings-of-two-looks-a-6c31306c = 两次查看的开始之间的时间；慢的线路需要更久

# Time from one scan to the next; a longer constant scan time of the program takes precedence. Default: the program's constant scan time, or 10ms
t-time-from-one-scan-to-the-next-a-4db21209 = 两次扫描之间的时间；程序的恒定扫描时间更长时以其为准。默认：程序的恒定扫描时间，或 10ms

# Time limit of the search, in real time. With it, results depend on the speed of the machine
t-time-limit-of-the-search-in-real-time-efdeceee = 搜索的时间限制，以实际时间计。使用它时，结果取决于机器的速度

# Time limit per property, in real time. With it, verdicts depend on the speed of the machine. Default: that of rungc.toml, or none
t-time-limit-per-property-in-real-time-with-7d086f93 = 每个性质的时间限制，以实际时间计。使用它时，判定取决于机器的速度。默认：rungc.toml 中的限制，或没有

# Time of the moment in the recording. Default: its end
t-time-of-the-moment-in-the-recording-default-be47b509 = 记录中的时刻。默认：记录的结尾

# Time to run: `200ms`, `5s`, `2min`, `1h`; a bare number is milliseconds. Default: until Ctrl-C
t-time-to-run-200ms-5s-2min-1h-a-80f0b3ae = 运行的时间：`200ms`、`5s`、`2min`、`1h`；单独的数字为毫秒。默认：直到 Ctrl-C

# Time to wait for a response
t-time-to-wait-for-a-response-a17b5c35 = 等待响应的时间

# Time to wait for the boot loader while you set BOOT0 and reset the board, or for a volume to disappear
t-time-to-wait-for-the-boot-loader-while-7fdc71ed = 在设置 BOOT0 并复位电路板时等待引导程序的时间，或等待卷消失的时间

# Treat a limit of the model with this code (E0105) or name (limits) as a warning; may be repeated or separated by commas. The PLC rejects the program, but it can be compiled
t-treat-a-limit-of-the-model-with-this-678a838a = 把具有此代码（E0105）或名称（limits）的机型限制当作警告；可重复给出或用逗号分隔。PLC 不接受该程序，但可以编译

# Treat warnings as errors
t-treat-warnings-as-errors-81635ea3 = 把警告当作错误

# Treat warnings with this code or name as errors; may be repeated or separated by commas
t-treat-warnings-with-this-code-or-name-as-145024e8 = 把具有此代码或名称的警告当作错误；可重复给出或用逗号分隔

# Tries sequences of inputs, and extends those that reach new behaviour. Prints the shortest run for each finding. Exit codes: 0: nothing found, which is not a proof; 1: found; 2: incorrect usage, or errors in the program
t-tries-sequences-of-inputs-and-extends-those-that-f1dd890a = 尝试输入的序列，并延伸那些达到新行为的序列。对每个发现输出最短的过程。退出码：0：未发现问题，这不是证明；1：有发现；2：用法错误，或程序有错误

# Usage
t-usage-740f2048 = 用法

# Use a debug probe for this part, through probe-rs, which must be installed: `STM32F103VC`
t-use-a-debug-probe-for-this-part-through-05903e6c = 通过 probe-rs 用调试探头写入此器件，须已安装 probe-rs：`STM32F103VC`

# Use of colours
t-use-of-colours-993c0abc = 是否使用颜色

# Values of latched devices at the start of a run
t-values-of-latched-devices-at-the-start-of-118b984d = 运行开始时停电保持软元件的值

# Values saved by an earlier run: the search also switches the power off and on
t-values-saved-by-an-earlier-run-the-search-a0537d16 = 先前运行保存的值：搜索还会断电和上电

# Virtual time to run: `200ms`, `5s`, `2min`, `1h`; a bare number is milliseconds. Default: 1s, or with a server until Ctrl-C
t-virtual-time-to-run-200ms-5s-2min-1h-9f365cba = 运行的虚拟时间：`200ms`、`5s`、`2min`、`1h`；单独的数字为毫秒。默认：1s；有服务器时直到 Ctrl-C

# With --plot: plot against this value instead of time, such as a slave axis against its master
t-with-plot-plot-against-this-value-instead-of-cf02e010 = 与 --plot 一起使用：以此值代替时间作横轴，例如从轴对主轴

# With --report: count the mutants (`rungc book mutants`) that the cases of each requirement notice
t-with-report-count-the-mutants-rungc-book-mutants-15e04564 = 与 --report 一起使用：统计各要求的用例所发现的变异体（`rungc book mutants`）

# Without a run, lists what can switch the device. With --set, --for or --machine, the program runs to that moment, and the answer says what keeps the device as it is, since when, and what would change it
t-without-a-run-lists-what-can-switch-the-d1d71a9e = 不运行时，列出哪些指令能改变该软元件。使用 --set、--for 或 --machine 时，程序运行到该时刻，回答说明软元件由什么保持、自何时起、以及怎样能改变它

# Workflow commands of GitHub Actions, which mark findings at their lines
t-workflow-commands-of-github-actions-which-mark-findings-10a1816f = GitHub Actions 的工作流命令，在相应的行标出发现

# Workflow commands of GitHub Actions, which mark the places of failed cases
t-workflow-commands-of-github-actions-which-mark-the-69e9a1fb = GitHub Actions 的工作流命令，标出失败用例的位置

# Write a file: a page (.html) or document (.pdf) of the whole program, or a picture (.svg) of the selected networks. With several programs, a folder for their pages
t-write-a-file-a-page-html-or-document-7ddbf7a9 = 写入文件：整个程序的页面（.html）或文档（.pdf），或所选网络的图（.svg）。有多个程序时，为存放其页面的文件夹

# Write a report for an assessor (`rungc book requirements`): requirements, proofs, assumptions, gaps, runs and tests. A page (.html), a document (.pdf) or JSON (.json)
t-write-a-report-for-an-assessor-rungc-book-46b7248e = 写出供评估人员使用的报告（`rungc book requirements`）：要求、证明、假设、缺口、运行过程和测试。页面（.html）、文档（.pdf）或 JSON（.json）

# Write an example project into a new folder, and print a tour of its commands
t-write-an-example-project-into-a-new-folder-fd379cab = 把示例项目写入新文件夹，并输出其命令的导览

# Write rungc.toml, the commented settings of a project, and AGENTS.md for assistants
t-write-rungc-toml-the-commented-settings-of-a-93dee03e = 写入 rungc.toml（带注释的项目设置）和供助手使用的 AGENTS.md

# Write the documentation of a machine: terminals, what drives each output, timers, instructions, open questions
t-write-the-documentation-of-a-machine-terminals-what-a244dace = 编写机器的文档：端子、各输出的驱动条件、定时器、指令、待确认事项

# Write the proof to this folder as formulas (`*.cnf`) that any SAT solver can confirm to be unsatisfiable; each of several properties has a folder in it. With --same-as, the proofs of all equal outputs
t-write-the-proof-to-this-folder-as-formulas-1ac6cc57 = 把证明写入此文件夹，形式为任何 SAT 求解器都能确认不可满足的公式（`*.cnf`）；有多个性质时各有一个子文件夹。使用 --same-as 时，为全部相同输出的证明

# Write the runs found to a test file, whose cases fail until the program is repaired: `rungc test FILE`
t-write-the-runs-found-to-a-test-file-6a2a157e = 把找到的运行过程写入测试文件，其用例在程序修复之前会失败：`rungc test FILE`

# Write the runs to a test file, which fails until the program is corrected: `rungc test FILE`
t-write-the-runs-to-a-test-file-which-1b375498 = 把运行过程写入测试文件，在程序改正之前它会失败：`rungc test FILE`

# Write the same model in BTOR2, in which bits are named after their devices
t-write-the-same-model-in-btor2-in-which-1d426636 = 把同一模型写成 BTOR2，其中的位以其软元件命名

# Write the single property as a model for other model checkers (AIGER): the property is violated if the model's output can be on
t-write-the-single-property-as-a-model-for-6caf37ff = 把唯一的性质写成供其他模型检查器使用的模型（AIGER）：模型的输出能为 ON 时，性质被违反

# `ms,device,value`: a row for each value at first, then for each change
t-ms-device-value-a-row-for-each-value-f9976a6c = `ms,device,value`：先为每个值一行，然后每次变化一行

# default
t-default-933b5bde = 默认

# possible values
t-possible-values-a2c8a064 = 可选值
