# 1 leads to the high word of `{device}`, 2 to the next counter
t-1-leads-to-the-high-word-of-device-abbbbc6f = 1 指向 `{ $device }` 的高位字，2 指向下一个计数器

# a call that is too deep is skipped with error 6702 when it is reached
t-a-call-that-is-too-deep-is-skipped-91f5ade5 = 过深的调用执行到时被跳过，错误代码为 6702

# a high-speed counter counts while its coil is driven: `OUT {counter} K…`
t-a-high-speed-counter-counts-while-its-coil-01240c73 = 高速计数器在线圈被驱动期间计数：`OUT { $counter } K…`

# a loop
t-a-loop-98ec749a = 循环

# a master control zone
t-a-master-control-zone-3a03c20b = 主控区间

# a PLC may reject it
t-a-plc-may-reject-it-470d4dec = PLC 可能不接受

# a program contains at least END
t-a-program-contains-at-least-end-c3cee806 = 程序至少要有 END

# a program with this instruction cannot be built
t-a-program-with-this-instruction-cannot-be-built-cd50ea64 = 含有此指令的程序不能编译

# a protocol that is chosen only here is missing from a compiled program
t-a-protocol-that-is-chosen-only-here-is-12b3fc6f = 仅在此处选择的协议，编译后的程序中没有

# a step ladder
t-a-step-ladder-23f4ef8a = 步进梯形图

# a subroutine
t-a-subroutine-b128456e = 子程序

# a subroutine ends with SRET, an interrupt routine with IRET
t-a-subroutine-ends-with-sret-an-interrupt-routine-45741b92 = 子程序以 SRET 结束，中断程序以 IRET 结束

# add a `[[module]]` with its kind to rungc.toml: one of {many}
t-add-a-module-with-its-kind-to-rungc-822271eb = 在 rungc.toml 中加入相应类型的 `[[module]]`，类型为以下之一：{ $many }

# add a `[[module]]` with the kind {one} to rungc.toml
t-add-a-module-with-the-kind-one-to-85ba2054 = 在 rungc.toml 中加入类型为 { $one } 的 `[[module]]`

# add END after it
t-add-end-after-it-e0dcdd74 = 在其后加 END

# add END
t-add-end-b507b8b1 = 加 END

# add `RST M{mask}` where it may run, for example under M8002
t-add-rst-m-mask-where-it-may-run-43837790 = 在允许它执行的位置加 `RST M{ $mask }`，如由 M8002 驱动

# add `SET M{number}` where it should run
t-add-set-m-number-where-it-should-run-70a1ab26 = 在应执行它的位置加 `SET M{ $number }`

# add `SET M{relay}` where it may run, for example under M8002
t-add-set-m-relay-where-it-may-run-c0000eb6 = 在允许它执行的位置加 `SET M{ $relay }`，如由 M8002 驱动

# {all} have no effect in a compiled program: {why}
t-all-have-no-effect-in-a-compiled-program-55d9cac5 = { $all } 在编译后的程序中不起作用：{ $why }

# always jumps back …
t-always-jumps-back-8b9c5330 = 总是从此处跳回...

# an enhanced N:N link
t-an-enhanced-n-n-link-23aa5fc6 = 增强型 N:N 网络

# an interrupt routine
t-an-interrupt-routine-d2559fcd = 中断程序

# an N:N link
t-an-n-n-link-20d41274 = N:N 网络

# an operation error each time this runs
t-an-operation-error-each-time-this-runs-19f0655d = 每次执行都产生运算错误

# an operation error each time this runs; the result does not change
t-an-operation-error-each-time-this-runs-the-a7f4bbfa = 每次执行都发生运算错误；结果不变

# … and again here
t-and-again-here-451662f4 = { "." }..在此处又一次

# … and again here: this one decides its state
t-and-again-here-this-one-decides-its-state-41fa0fe0 = { "." }..在此处又一次：由这一处决定其状态

# … and again here: this one decides the state of the coil
t-and-again-here-this-one-decides-the-state-bf6fd7f4 = { "." }..在此处又一次：由这一处决定线圈的状态

# and alone drives this
t-and-alone-drives-this-392f4b26 = 只有后一块驱动此处

# … and counts here
t-and-counts-here-0644ffb0 = { "." }..又在此处计数

# … and here
t-and-here-b037ffb0 = { "." }..此处也使用

# … and in this one
t-and-in-this-one-15549e7b = { "." }..以及在这个分支中

# … and in this one, which decides while both run
t-and-in-this-one-which-decides-while-both-d7912016 = { "." }..以及在这个分支中，两者都执行时由它决定

# … and otherwise here
t-and-otherwise-here-69b35e62 = { "." }..在此处另作设定

# … and request an interrupt here
t-and-request-an-interrupt-here-2e2bb4b5 = { "." }..又在此处请求中断

# … and used here
t-and-used-here-315d204b = { "." }..又在此处使用

# at most eight parallel branches can be joined
t-at-most-eight-parallel-branches-can-be-joined-dd7698c1 = 最多汇合八个并行分支

# at {n} places
t-at-n-places-e5ff29f8 = 在 { $n } 处

# BFM {number} of {name} (module {unit}) can only be read: {what}
t-bfm-number-of-name-module-unit-can-only-8650bfbb = { $name }（模块 { $unit }）的 BFM { $number } 只能读出：{ $what }

# BFM {number} of {name} (module {unit}) is reserved
t-bfm-number-of-name-module-unit-is-reserved-5b50c208 = { $name }（模块 { $unit }）的 BFM { $number } 属于保留区

# … but N{open} is open
t-but-n-open-is-open-ac6911aa = { "." }..但尚未结束的是 N{ $open }

# … but no {end} has closed this
t-but-no-end-has-closed-this-ee32d526 = { "." }..但此结构尚未用 { $end } 结束

# … but {protocol} here
t-but-protocol-here-dc0105a2 = { "." }..但此处为「{ $protocol }」

# but this {within} is still open
t-but-this-within-is-still-open-a24e4bf7 = 但此{ $within }尚未结束

# `C{number}` and `C{number2}` both use `{input}`
t-c-number-and-c-number2-both-use-input-fc3d8734 = `C{ $number }` 和 `C{ $number2 }` 都使用 `{ $input }`

# called here
t-called-here-843850fe = 在此处调用

# calls itself through this
t-calls-itself-through-this-e2e2776c = 由此调用自身

# calls may nest {depth} deep, but {name} allows {max}
t-calls-may-nest-depth-deep-but-name-allows-4b22b662 = 调用可能嵌套 { $depth } 层，但 { $name } 最多允许 { $max } 层

# calls nest {depth} deep, but {name} allows {max}
t-calls-nest-depth-deep-but-name-allows-max-2368b79d = 调用嵌套 { $depth } 层，但 { $name } 最多允许 { $max } 层

# change the PLC parameters in the editor, or choose another model with `--model`
t-change-the-plc-parameters-in-the-editor-or-e26a49e5 = 在编程软件中修改 PLC 参数，或用 `--model` 选择其他机型

# close branches with MPP, or start a new rung with a relay that holds the result
t-close-branches-with-mpp-or-start-a-new-c0069fed = 用 MPP 结束分支，或用存放结果的继电器开始新的网络

# coil `{device}` is driven in branches that run at the same time
t-coil-device-is-driven-in-branches-that-run-94ac1a8e = 线圈 `{ $device }` 在同时执行的分支中被驱动

# coil `{name}` is driven {times}; only the last result counts
t-coil-name-is-driven-times-only-the-last-3c04011c = 双线圈：`{ $name }` { $times }被驱动，只有最后一次的结果有效

# coil `{output}` is also the output of `{mnemonic}`
t-coil-output-is-also-the-output-of-mnemonic-f9fed463 = 线圈 `{ $output }` 也是 `{ $mnemonic }` 的输出

# COM3 is a Modbus RTU slave
t-com3-is-a-modbus-rtu-slave-4e62920e = COM3 是 Modbus RTU 从站

# COM3 is set up for the Ethernet card H2U-ENET-BD, which there is not
t-com3-is-set-up-for-the-ethernet-card-ddcd4eca = COM3 设定为以太网卡 H2U-ENET-BD 使用，但没有安装此卡

# connected directly to the bus
t-connected-directly-to-the-bus-08606c76 = 直接接在母线上

# copy the counters to data registers, and index these
t-copy-the-counters-to-data-registers-and-index-4416b395 = 把计数器复制到数据寄存器，再对数据寄存器变址

# {count} circuits branch off in the flow of `{initial}`, but the PLC supports {MAX_BRANCHES}
t-count-circuits-branch-off-in-the-flow-of-964e44e4 = `{ $initial }` 的流程中有 { $count } 条分支回路，但 PLC 最多支持 { $MAX_BRANCHES } 条

# counter `C{number}`
t-counter-c-number-299c8851 = 计数器 `C{ $number }`

# counts here
t-counts-here-fdc6de39 = 在此处计数

# `D{n}` becomes H{value} here
t-d-n-becomes-h-value-here-4ed8fc96 = `D{ $n }` 在此处变为 H{ $value }

# `D{n}`{left} excludes the {edge} edge of `{input}`
t-d-n-left-excludes-the-edge-edge-of-ac31fe2d = `{ $input }` 的{ $edge }沿不进入中断，原因在于 `D{ $n }`{ $left }

# defined again here
t-defined-again-here-6437732c = 在此处再次定义

# delete one of the two, or give it another number
t-delete-one-of-the-two-or-give-it-9f5688f7 = 删除其中一个，或改用其他编号

# delete the label
t-delete-the-label-84d04847 = 删除标号

# delete the label, or name it in the CJ or CALL that should lead here
t-delete-the-label-or-name-it-in-the-b0560b2c = 删除此标号，或在应到达此处的 CJ 或 CALL 中写上它

# delete this label: jumps to P63 end the scan without it
t-delete-this-label-jumps-to-p63-end-the-7d4b6737 = 删除此标号：没有它，跳转到 P63 也会结束扫描

# delete this MCR, or put MC where the zone starts
t-delete-this-mcr-or-put-mc-where-the-490cb8ef = 删除此 MCR，或在区间开始处加 MC

# delete this {name}, or put MPS where the branch starts
t-delete-this-name-or-put-mps-where-the-b9bb65d0 = 删除此 { $name }，或在分支开始处加 MPS

# delete this {name}, or put the label of the {kind} before it
t-delete-this-name-or-put-the-label-of-03df7122 = 删除此 { $name }，或在它之前加{ $kind }的标号

# delete this {name}, or start the second block with LD
t-delete-this-name-or-start-the-second-block-344a00a2 = 删除此 { $name }，或用 LD 开始第二个回路块

# delete this NEXT, or put FOR where the loop starts
t-delete-this-next-or-put-for-where-the-e5c00b57 = 删除此 NEXT，或在循环开始处加 FOR

# `{device}` counts here
t-device-counts-here-fbf7a7e5 = `{ $device }` 在此处计数

# `{device}` does not count an input of {model}
t-device-does-not-count-an-input-of-model-3118cf83 = `{ $device }` 在 { $model } 上没有可以计数的输入

# `{device}` driven here
t-device-driven-here-cf15eb13 = `{ $device }` 在此处驱动

# `{device}` has a meaning on {names}: `rungc explain {device}`
t-device-has-a-meaning-on-names-rungc-explain-39d7540a = `{ $device }` 在 { $names } 上有含义：`rungc explain { $device }`

# `{device}` is both jumped to and called
t-device-is-both-jumped-to-and-called-da39efa8 = `{ $device }` 既被跳转又被调用

# `{device}` is defined twice
t-device-is-defined-twice-ad078ef0 = `{ $device }` 重复定义

# `{device}` is driven in branches that run at the same time
t-device-is-driven-in-branches-that-run-at-c6a5942d = `{ $device }` 在同时执行的分支中被驱动

# `{device}` is not always set in the first scan, at whose end {model} fixes the protocol of {self}
t-device-is-not-always-set-in-the-first-b033dba4 = { $model } 在第一次扫描结束时确定 { $self } 的协议，而 `{ $device }` 在第一次扫描中不一定已设定

# `{device}` is not on {variant}
t-device-is-not-on-variant-34ca57d8 = { $variant } 上没有 `{ $device }`

# `{device}` is read here
t-device-is-read-here-75593743 = `{ $device }` 在此处读取

# `{device}` is updated only in scans that run {name}
t-device-is-updated-only-in-scans-that-run-0014842c = `{ $device }` 只在执行{ $name }的扫描中更新

# `{device}` is written here
t-device-is-written-here-b4402154 = `{ $device }` 在此处写入

# `{device}` measures here
t-device-measures-here-e84ab6b6 = `{ $device }` 在此处计时

# `{device}` never runs: {why}
t-device-never-runs-why-d661ef2d = `{ $device }` 从不执行：{ $why }

# `{device}` of {self} is set to two values
t-device-of-self-is-set-to-two-values-7b0f8b35 = { $self } 的 `{ $device }` 设为两个不同的值

# `{device}` of {title} cannot give the direction of pulses
t-device-of-title-cannot-give-the-direction-of-168f2b73 = { $title } 的 `{ $device }` 不能给出脉冲的方向

# `{device}` read here
t-device-read-here-0730e635 = `{ $device }` 在此处读取

# `{device}` set here
t-device-set-here-d5eb0b43 = `{ $device }` 在此处置位

# do the work of the inner loops in one loop
t-do-the-work-of-the-inner-loops-in-5a3c005e = 把内层循环的工作放在一个循环中完成

# drive it after RET, with the contacts of both states
t-drive-it-after-ret-with-the-contacts-of-e4e218af = 在 RET 之后用两个状态的触点驱动它

# drive it in the main program
t-drive-it-in-the-main-program-c948d83d = 在主程序中驱动它

# drive it in the main program, or call the subroutine in every scan
t-drive-it-in-the-main-program-or-call-ee30c382 = 在主程序中驱动它，或在每次扫描中调用该子程序

# driven at the same time as this one
t-driven-at-the-same-time-as-this-one-200cc718 = 与另一条指令同时驱动

# driven here
t-driven-here-0f80a7f7 = 在此处驱动

# … driven here …
t-driven-here-87b51717 = { "." }..在此处驱动...

# driven here too
t-driven-here-too-f74842c1 = 此处也驱动

# driven in one branch …
t-driven-in-one-branch-faa97216 = 在一个分支中驱动...

# end it with {end}
t-end-it-with-end-0efc77fc = 用 { $end } 结束它

# end the loop with NEXT
t-end-the-loop-with-next-8b932cd8 = 用 NEXT 结束循环

# end the main program with FEND and put routines after it
t-end-the-main-program-with-fend-and-put-cd0fb6d5 = 用 FEND 结束主程序，把子程序和中断程序放在其后

# end the {outside} with {end} before it, or move the {within} out
t-end-the-outside-with-end-before-it-or-cb2625c9 = 在它之前用 { $end } 结束{ $outside }，或把{ $within }移到外面

# end the rung with a coil before it, or delete these contacts
t-end-the-rung-with-a-coil-before-it-d4f87bcf = 在它之前用线圈结束网络，或删除这些触点

# end the rung with a coil before it, or jump over the loop with CJ if it is to run under a condition
t-end-the-rung-with-a-coil-before-it-e9c69b4a = 在它之前用线圈结束网络；如果循环要有条件地执行，用 CJ 跳过循环

# end the rung with a coil or an instruction
t-end-the-rung-with-a-coil-or-an-0e86035f = 在网络末尾加线圈或指令

# end the zone with `MCR{level}`
t-end-the-zone-with-mcr-level-3d3ca187 = 用 `MCR{ $level }` 结束区间

# ends N{level} …
t-ends-n-level-28a7871b = 在此处结束 N{ $level }...

# ends the {outside} …
t-ends-the-outside-ad21c75b = { $outside }在此处结束...

# falling
t-falling-6aa25568 = 下降

# `{family}` stands for all PLCs of the family
t-family-stands-for-all-plcs-of-the-family-9ff03586 = `{ $family }` 代表该系列的所有 PLC

# fast inputs and outputs take {asked} units of hardware, {model} has {total}
t-fast-inputs-and-outputs-take-asked-units-of-560b9841 = 快速输入和输出占用 { $asked } 个单位的硬件资源，{ $model } 只有 { $total } 个

# FEND inside {one}
t-fend-inside-one-4d281b24 = FEND 位于{ $one }之内

# finds the axis in use
t-finds-the-axis-in-use-6fcf1833 = 发现轴已被占用

# finds the output in use
t-finds-the-output-in-use-ba5d19cf = 发现输出已被占用

# finds the zone in use
t-finds-the-zone-in-use-d543cdbe = 发现区域已被占用

# {fine} continue by themselves and keep their value until RST, too, but count 1 ms: convert a preset given in {unit_ms} ms units
t-fine-continue-by-themselves-and-keep-their-value-e6f62ddf = { $fine } 也能自行继续计时，并把当前值保持到 RST，但以 1 ms 为单位计时：须换算以 { $unit_ms } ms 为单位的设定值

# `{first}` and 1 other device are driven and never read
t-first-and-1-other-device-are-driven-and-88f21dce = `{ $first }` 和另外 1 个软元件被驱动但从未读取

# `{first}` and 1 other device are read, but nothing drives them
t-first-and-1-other-device-are-read-but-27bebab6 = 读取了 `{ $first }` 和另外 1 个软元件，但没有任何指令驱动它们

# `{first}` and 1 other device are read, but nothing writes them
t-first-and-1-other-device-are-read-but-ed7c93e5 = 读取了 `{ $first }` 和另外 1 个软元件，但没有任何指令写入它们

# `{first}` and {n} more registers are reserved for the system of {title}
t-first-and-n-more-registers-are-reserved-for-b7e9265f = `{ $first }` 和另外 { $n } 个寄存器保留给 { $title } 的系统使用

# `{first}` and {n} more special devices have no meaning on {model_name}
t-first-and-n-more-special-devices-have-no-1472a1d9 = `{ $first }` 和另外 { $n } 个特殊软元件在 { $model_name } 上没有意义

# `{first}` and {n} other devices are driven and never read
t-first-and-n-other-devices-are-driven-and-2c1f24a6 = `{ $first }` 和另外 { $n } 个软元件被驱动但从未读取

# `{first}` and {n} other devices are read, but nothing writes them
t-first-and-n-other-devices-are-read-but-388036ad = 读取了 `{ $first }` 和另外 { $n } 个软元件，但没有任何指令写入它们

# `{first}` and {n} other devices are read, but nothing drives them
t-first-and-n-other-devices-are-read-but-d078443e = 读取了 `{ $first }` 和另外 { $n } 个软元件，但没有任何指令驱动它们

# first defined here
t-first-defined-here-7c46946a = 先在此处定义

# first driven here …
t-first-driven-here-436b4f45 = 先在此处驱动...

# `{first}` has no meaning on {model_name}
t-first-has-no-meaning-on-model-name-5c799e69 = `{ $first }` 在 { $model_name } 上没有意义

# `{first}` is a register of the network on a station of CANlink
t-first-is-a-register-of-the-network-on-a0aff718 = `{ $first }` 在 CANlink 站中是通信网络的寄存器

# `{first}` is driven and never read
t-first-is-driven-and-never-read-03c1d482 = `{ $first }` 被驱动但从未读取

# `{first}` is read, but nothing drives it
t-first-is-read-but-nothing-drives-it-8646e035 = 读取了 `{ $first }`，但没有任何指令驱动它

# `{first}` is read, but nothing writes it
t-first-is-read-but-nothing-writes-it-3526bb56 = 读取了 `{ $first }`，但没有任何指令写入它

# `{first}` is reserved for the system of {title}
t-first-is-reserved-for-the-system-of-title-573f0829 = `{ $first }` 保留给 { $title } 的系统使用

# `{first}` is set and never reset
t-first-is-set-and-never-reset-d5e612a9 = `{ $first }` 被置位后从不复位

# `{first}` reaches its preset once and is never reset
t-first-reaches-its-preset-once-and-is-never-fb2b4778 = `{ $first }` 到达一次设定值后从不复位

# first starts here
t-first-starts-here-84bed304 = 先在此处开始

# {first} to {last}
t-first-to-last-65d83c5c = { $first }～{ $last }

# `{first}` to `{run}`
t-first-to-run-eacc3eb7 = `{ $first }`～`{ $run }`

# `{first}` with an index may be `{near}`, which sets up a serial port
t-first-with-an-index-may-be-near-which-1ac97a3b = 带变址的 `{ $first }` 可能是用于设定串口的 `{ $near }`

# first written here …
t-first-written-here-a9139370 = 先在此处写入...

# {free} continue by themselves, but count 100 ms: convert a preset given in {unit_ms} ms units{fine}
t-free-continue-by-themselves-but-count-100-ms-90f1c985 = { $free } 自行继续计时，但以 100 ms 为单位：须换算以 { $unit_ms } ms 为单位的设定值{ $fine }

# {free} continue by themselves in scans that do not run their coils
t-free-continue-by-themselves-in-scans-that-do-0f3026f2 = 在不执行其线圈的扫描中，{ $free } 自行继续计时

# `{from}` branches into {transitions} states, the PLC follows {MAX_BRANCH}
t-from-branches-into-transitions-states-the-plc-follows-de0449e0 = `{ $from }` 分支到 { $transitions } 个状态，PLC 最多执行 { $MAX_BRANCH } 个

# give each its own zone, 0 to 5
t-give-each-its-own-zone-0-to-5-c3f889e1 = 各自使用单独的区域，0 到 5

# give each zone a separate relay
t-give-each-zone-a-separate-relay-42bd27fe = 每个主控区使用单独的继电器

# give one of the two another number, or merge both into one section
t-give-one-of-the-two-another-number-or-06e1c001 = 其中一个改用其他编号，或把两段合并为一段

# give the direction by an output that sends no pulses
t-give-the-direction-by-an-output-that-sends-25517624 = 用不发出脉冲的输出给出方向

# give the jump a condition, or remove the instructions it skips
t-give-the-jump-a-condition-or-remove-the-7769d63b = 给跳转加条件，或删除它跳过的指令

# give the jump a condition that ends the loop
t-give-the-jump-a-condition-that-ends-the-5d1c28ad = 给跳转加上能结束循环的条件

# give the subroutine its own label
t-give-the-subroutine-its-own-label-ea0af4e3 = 给子程序单独的标号

# give them conditions that are never on at the same time
t-give-them-conditions-that-are-never-on-at-6e24d6ef = 使它们的条件不会同时接通

# gives the limit of the range each time this runs
t-gives-the-limit-of-the-range-each-time-0caab7dc = 每次执行的结果都是范围的极限值

# go to another state with SET and its STL
t-go-to-another-state-with-set-and-its-2e50bd3c = 转移到其他状态时使用 SET 和该状态的 STL

# if this sets up the port, name the register: `{near}`
t-if-this-sets-up-the-port-name-the-223d0043 = 如果此处设定串口，直接写出寄存器：`{ $near }`

# `{index}` counts the words of `{device}`, not counters
t-index-counts-the-words-of-device-not-counters-204a81da = `{ $index }` 按 `{ $device }` 的字计算，而不是按计数器计算

# {inner} is not allowed inside {outer}
t-inner-is-not-allowed-inside-outer-9ddf0e89 = { $outer }之内不允许有{ $inner }

# `{input}` serves both an interrupt and pulse catch
t-input-serves-both-an-interrupt-and-pulse-catch-54a93da1 = `{ $input }` 既用于中断，又用于脉冲捕捉

# `{input}` serves both {inst} and {name}
t-input-serves-both-inst-and-name-484abfbc = `{ $input }` 有两种用途：{ $inst }、{ $name }

# `{input}` serves both {other} and counter `C{number}`
t-input-serves-both-other-and-counter-c-number-452fbef1 = `{ $input }` 有两种用途：{ $other }、计数器 `C{ $number }`

# … inside this loop
t-inside-this-loop-15b9986f = { "." }..位于此循环内

# `{inst}` cannot be compiled: {what}
t-inst-cannot-be-compiled-what-7457b378 = `{ $inst }` 不能编译：{ $what }

# `{instr}` has no contact to continue
t-instr-has-no-contact-to-continue-863ae148 = `{ $instr }` 前没有可以连接的触点

# instructions after END never run
t-instructions-after-end-never-run-f16ea804 = END 之后的指令从不执行

# interrupt routine
t-interrupt-routine-3ade60f0 = 中断程序

# interrupt routine `{device}` does not exist
t-interrupt-routine-device-does-not-exist-96446abd = 中断程序 `{ $device }` 不存在

# interrupts are disabled at the start of RUN
t-interrupts-are-disabled-at-the-start-of-run-920fe59b = RUN 开始时中断处于禁止状态

# is ignored while the other is driven
t-is-ignored-while-the-other-is-driven-f094ad7d = 在另一个被驱动期间被忽略

# is inside this {outside}
t-is-inside-this-outside-980fad46 = 位于此{ $outside }之中

# … is lost here
t-is-lost-here-0a65999d = { "." }..在此处丢失

# it can be compiled for: {models}
t-it-can-be-compiled-for-models-358c6129 = 可编译的机型：{ $models }

# it works if {when}
t-it-works-if-when-604a80af = 满足以下条件时有效：{ $when }

# its last one is {last}; an extension module has others
t-its-last-one-is-last-an-extension-module-dae6fd75 = 最后一个是 { $last }；其余的由扩展模块提供

# its last one is {last}
t-its-last-one-is-last-c9064fef = 最后一个是 { $last }

# its partners
t-its-partners-5e505ce4 = 其通信对象

# its partners then
t-its-partners-then-12b86843 = 此时的通信对象

# its pulse outputs are Y000 to {last}
t-its-pulse-outputs-are-y000-to-last-19de981e = 脉冲输出为 Y000～{ $last }

# its pulses are caught here …
t-its-pulses-are-caught-here-c9a87cd5 = 在此处捕捉其脉冲...

# its value never changes
t-its-value-never-changes-6f45d843 = 其值从不变化

# join the block with ANB or ORB first
t-join-the-block-with-anb-or-orb-first-d1b466a4 = 先用 ANB 或 ORB 连接回路块

# join the blocks with ANB (both) or ORB (either)
t-join-the-blocks-with-anb-both-or-orb-679bb3e7 = 用 ANB（串联）或 ORB（并联）连接回路块

# join the conditions with OR into one coil, or use SET and RST
t-join-the-conditions-with-or-into-one-coil-220772e6 = 用 OR 把条件合并到一个线圈，或使用 SET 和 RST

# jump to the FOR or past the NEXT
t-jump-to-the-for-or-past-the-next-9627d0bf = 跳转到 FOR 处，或跳到 NEXT 之后

# jumped to here
t-jumped-to-here-d1bfa2e9 = 在此处跳转

# jumps from here …
t-jumps-from-here-1725202c = 从此处跳转...

# label `{device}` does not exist
t-label-device-does-not-exist-9f6547fc = 标号 `{ $device }` 不存在

# leads nowhere
t-leads-nowhere-c3da9fc2 = 没有对应的标号

# leave one register between the two values
t-leave-one-register-between-the-two-values-fa3f94b6 = 两个数据之间留一个寄存器

# leave the output to `{mnemonic}`, or give the coil another one
t-leave-the-output-to-mnemonic-or-give-the-847e8cd0 = 把此输出留给 `{ $mnemonic }`，或让线圈使用另一个输出

# let the edge SET a relay that drives it, and RST the relay when it has ended
t-let-the-edge-set-a-relay-that-drives-4c4eac2a = 让边沿用 SET 置位一个继电器来驱动它，结束时用 RST 复位该继电器

# loop
t-loop-ddef486b = 循环

# loops nest {max} deep on {model}
t-loops-nest-max-deep-on-model-97f9fce0 = { $model } 的循环最多嵌套 { $max } 层

# `{lost}`{named} is to keep its value over power-off, but is not latched on {model}
t-lost-named-is-to-keep-its-value-over-6bb22195 = `{ $lost }`{ $named } 应在停电后保持其值，但它在 { $model } 上不是停电保持软元件

# `{lower}` holds 16 bits: use the 16-bit form of the instruction
t-lower-holds-16-bits-use-the-16-bit-7a193328 = `{ $lower }` 为 16 位：使用指令的 16 位形式

# `M{mask}`, which is on at power-on, forbids it
t-m-mask-which-is-on-at-power-on-24bd68f8 = 上电时为 ON 的 `M{ $mask }` 禁止它执行

# master
t-master-ca8dbf33 = 主站

# master control zone
t-master-control-zone-c1e5d068 = 主控区间

# may be
t-may-be-0d4f8aaf = 可能是

# may take effect only after the next change from STOP to RUN
t-may-take-effect-only-after-the-next-change-19433602 = 可能要到下次从 STOP 切换到 RUN 后才生效

# measures here
t-measures-here-345d0c3a = 在此处计时

# measures incorrectly if not every scan does
t-measures-incorrectly-if-not-every-scan-does-ba3b8a87 = 如果不是每次扫描都执行，则计时不准

# {memory_steps} steps are used
t-memory-steps-steps-are-used-03e38022 = 按 { $memory_steps } 步处理

# {message}, and {n} more
t-message-and-n-more-7de7b8f2 = { $message }，另有 { $n } 个

# `{mnemonic}` always fails with `{kind}`
t-mnemonic-always-fails-with-kind-2c0bf39d = `{ $mnemonic }` 使用 `{ $kind }` 总是失败

# `{mnemonic}` changes `{device}` in every scan while its contacts are closed
t-mnemonic-changes-device-in-every-scan-while-its-9f986a05 = 触点接通期间，`{ $mnemonic }` 每次扫描都改变 `{ $device }`

# `{mnemonic} {device}` does not last: `OUT {device}` writes the coil in every scan
t-mnemonic-device-does-not-last-out-device-writes-455cdd4e = `{ $mnemonic } { $device }` 的结果不能保持：`OUT { $device }` 每次扫描都写入线圈

# `{mnemonic} {device}` does not last: `{writer}` writes the coil in every scan
t-mnemonic-device-does-not-last-writer-writes-the-dd4b38bf = `{ $mnemonic } { $device }` 的结果不能保持：`{ $writer }` 每次扫描都写入线圈

# `{mnemonic}` divides by zero
t-mnemonic-divides-by-zero-032b32b2 = `{ $mnemonic }` 的除数为零

# `{mnemonic}` is driven for one scan, but stops when its contacts open
t-mnemonic-is-driven-for-one-scan-but-stops-2694e5fa = `{ $mnemonic }` 只被驱动一次扫描，而它在触点断开时停止

# `{mnemonic}` must not have contacts before it
t-mnemonic-must-not-have-contacts-before-it-891217e4 = `{ $mnemonic }` 前不允许有触点

# `{mnemonic}` needs a contact before it
t-mnemonic-needs-a-contact-before-it-8c64f083 = `{ $mnemonic }` 前需要触点

# {mnemonic} reaches a remote module beside CANlink
t-mnemonic-reaches-a-remote-module-beside-canlink-fd8a6325 = { $mnemonic } 访问远程模块，同时又使用 CANlink

# `{mnemonic}` resets `{first}` alone
t-mnemonic-resets-first-alone-3f0f8cd8 = `{ $mnemonic }` 只复位 `{ $first }` 一个

# `{mnemonic}`{with} may be used only {often} in a program
t-mnemonic-with-may-be-used-only-often-in-90b8dc96 = 超过一个程序中允许的使用次数（{ $often }）：`{ $mnemonic }`{ $with }

# `{mnemonic}` works on {name}, which has no protocol
t-mnemonic-works-on-name-which-has-no-protocol-c01eef5b = `{ $mnemonic }` 使用 { $name }，而该端口没有协议

# `{mnemonic}` works on {name}, which is a {protocol}
t-mnemonic-works-on-name-which-is-a-protocol-ee536333 = `{ $mnemonic }` 使用 { $name }，而该端口设为「{ $protocol }」

# `{mnemonic}` writes `{device}`, which the system maintains
t-mnemonic-writes-device-which-the-system-maintains-0def55b6 = `{ $mnemonic }` 写入由系统维护的 `{ $device }`

# `{mnemonic}` writes one half of the 32-bit value in `{first}` and `{last}`
t-mnemonic-writes-one-half-of-the-32-bit-b340e8ea = `{ $mnemonic }` 写入了 `{ $first }` 和 `{ $last }` 中 32 位数据的一半

# `{mnemonic}` writes `{part}`, which is part of the result of `{writer}` at `{first}`
t-mnemonic-writes-part-which-is-part-of-the-d277dbf4 = `{ $mnemonic }` 写入 `{ $part }`，而它是 `{ $writer }` 存放在 `{ $first }` 的结果的一部分

# Modbus ASCII master
t-modbus-ascii-master-1989ced2 = Modbus ASCII 主站

# Modbus ASCII slave
t-modbus-ascii-slave-94f236f7 = Modbus ASCII 从站

# Modbus RTU master
t-modbus-rtu-master-dd3e7218 = Modbus RTU 主站

# Modbus RTU slave
t-modbus-rtu-slave-84cf1f61 = Modbus RTU 从站

# `[[module]]` in rungc.toml lists {listed}
t-module-in-rungc-toml-lists-listed-4ca36661 = rungc.toml 的 `[[module]]` 列出的模块：{ $listed }

# more than eight blocks are waiting to be joined
t-more-than-eight-blocks-are-waiting-to-be-79c448e6 = 等待连接的回路块超过 8 个

# more than eleven branches are open
t-more-than-eleven-branches-are-open-14c5cfee = 打开的分支超过 11 个

# {most} and {last}
t-most-and-last-b8e24f63 = { $most } 和 { $last }

# motions of the axis that need it do not start
t-motions-of-the-axis-that-need-it-do-c3e1e02f = 需要它的轴运动不会启动

# MPS has no result to store
t-mps-has-no-result-to-store-8215ba03 = MPS 没有可以存入的运算结果

# must be connected directly to the bus
t-must-be-connected-directly-to-the-bus-4ed19c28 = 必须直接接在母线上

# N{level} is not deeper than the zone around it
t-n-level-is-not-deeper-than-the-zone-e9bfa42d = N{ $level } 的嵌套级不大于外层区间

# {n} times
t-n-times-5bf6f189 = { $n } 次

# name a latched device in `[plcopen]` of rungc.toml, or add this one to `[latched]`
t-name-a-latched-device-in-plcopen-of-rungc-3cbb8b82 = 在 rungc.toml 的 `[plcopen]` 中写出停电保持的软元件，或把此软元件加入 `[latched]`

# `{name}` ends no {kind}
t-name-ends-no-kind-7fb067b3 = `{ $name }` 没有对应的{ $kind }

# `{name}` goes into a loop
t-name-goes-into-a-loop-a256dca5 = `{ $name }` 进入循环

# `{name}` is driven {times}
t-name-is-driven-times-a639db30 = `{ $name }` { $times }被驱动

# `{name}` is written {times}; only the last result counts
t-name-is-written-times-only-the-last-result-b2bff4fe = `{ $name }` { $times }被写入，只有最后一次的结果有效

# name it as the target of one, as in `DHSCS K100 C235 {pointer}`
t-name-it-as-the-target-of-one-as-3d490956 = 在比较指令中以它为目标，如 `DHSCS K100 C235 { $pointer }`

# `{name}` leaves a block that was not joined
t-name-leaves-a-block-that-was-not-joined-0890537e = `{ $name }` 离开了尚未连接的回路块

# {name} (module {unit}) has no BFM {number}
t-name-module-unit-has-no-bfm-number-c35cd22a = { $name }（模块 { $unit }）没有 BFM { $number }

# `{name}` needs two blocks
t-name-needs-two-blocks-b15edc35 = `{ $name }` 需要两个回路块

# `{name}` outside an advanced interrupt
t-name-outside-an-advanced-interrupt-f48532a1 = `{ $name }` 不在高级中断中

# `{name}` without MPS
t-name-without-mps-ec7b80d4 = `{ $name }` 缺少对应的 MPS

# {named} and {rest} more
t-named-and-rest-more-d5f3e524 = { $named } 及另外 { $rest } 个

# {names}: not every {title} has such devices
t-names-not-every-title-has-such-devices-c28113cd = { $names }：并非每台 { $title } 都有这样的软元件

# never acts
t-never-acts-ffb0f08e = 从不动作

# nine STL in a row
t-nine-stl-in-a-row-f0371edc = 连续九个 STL

# no chain of contacts has started
t-no-chain-of-contacts-has-started-03b78aa8 = 前面没有从母线开始的触点

# no comparison of a high-speed counter names it
t-no-comparison-of-a-high-speed-counter-names-e13cdd7c = 没有以它为目标的高速计数器比较指令

# no FOR is open here
t-no-for-is-open-here-cf2f1ab9 = 此处没有尚未结束的 FOR

# no frame can be for this station
t-no-frame-can-be-for-this-station-f85ba5cf = 任何帧都不可能发给此站

# no label leads here, and the code before it has ended
t-no-label-leads-here-and-the-code-before-baecbb4c = 没有标号通向此处，而它前面的程序已经结束

# no MC N{level} is open here
t-no-mc-n-level-is-open-here-4d9d3f8e = 此处没有尚未结束的 MC N{ $level }

# no MCR closes MC{level}
t-no-mcr-closes-mc-level-4d6836f9 = MC{ $level } 缺少对应的 MCR

# no module has the number {unit}
t-no-module-has-the-number-unit-31b500b0 = 没有编号为 { $unit } 的模块

# no MPP closes this branch
t-no-mpp-closes-this-branch-c538599e = 此分支没有用 MPP 结束

# no NEXT closes this FOR
t-no-next-closes-this-for-c16fe72f = 此 FOR 缺少对应的 NEXT

# no result is stored here
t-no-result-is-stored-here-c5349dda = 此处没有存入的运算结果

# no RET closes this step ladder
t-no-ret-closes-this-step-ladder-7a8fa5ac = 此步进梯形图缺少 RET

# no routine has started
t-no-routine-has-started-b11bc95f = 没有已开始的子程序或中断程序

# no step ladder is open here
t-no-step-ladder-is-open-here-a7a90f26 = 此处没有尚未结束的步进梯形图

# none is left for this
t-none-is-left-for-this-27d1ec9f = 已没有资源可供此处使用

# not cleared when this state starts
t-not-cleared-when-this-state-starts-bfda181c = 此状态开始时没有清零

# not run, up to `{last}`
t-not-run-up-to-last-5e764009 = 从此处到 `{ $last }` 都不执行

# not used
t-not-used-7d320327 = 未使用

# nothing drives `{counter}`, so it never counts
t-nothing-drives-counter-so-it-never-counts-f26999ca = `{ $counter }` 没有被驱动，因此从不计数

# nothing ends the loop that this jump forms
t-nothing-ends-the-loop-that-this-jump-forms-39c10733 = 此跳转形成的循环不会结束

# nothing is sent
t-nothing-is-sent-4dea27fc = 不发送任何内容

# nothing is sent or received
t-nothing-is-sent-or-received-b3f9c454 = 不发送也不接收

# nothing joins this block to the next one
t-nothing-joins-this-block-to-the-next-one-5d0ec2ef = 此回路块与下一块之间没有连接

# nothing jumps to `{device}` or calls it
t-nothing-jumps-to-device-or-calls-it-c0b2d007 = 没有任何指令跳转到 `{ $device }` 或调用它

# nothing switches `M{number}` on, which requests it
t-nothing-switches-m-number-on-which-requests-it-03271187 = 没有任何指令使请求它的 `M{ $number }` 变为 ON

# nothing switches `M{relay}` on, which allows it
t-nothing-switches-m-relay-on-which-allows-it-f2eb1b3b = 没有任何指令使允许它执行的 `M{ $relay }` 变为 ON

# nothing to run
t-nothing-to-run-600d1ba6 = 没有可执行的中断程序

# number nested zones N0, N1, N2 … from outside to inside, and close each with MCR
t-number-nested-zones-n0-n1-n2-from-outside-ff3b0d7f = 嵌套的区间从外到内编号为 N0、N1、N2...，每个都用 MCR 结束

# numbers of slaves
t-numbers-of-slaves-d31f5e26 = 从站的数量

# on the same CAN bus
t-on-the-same-can-bus-fdf00bff = 位于同一 CAN 总线上

# once
t-once-9188b0c4 = 一次

# one branch too many
t-one-branch-too-many-618674a2 = 多出的一个分支

# one call too many
t-one-call-too-many-046bce56 = 多出的一次调用

# {one} has no effect in a compiled program: {why}
t-one-has-no-effect-in-a-compiled-program-55494af8 = { $one } 在编译后的程序中不起作用：{ $why }

# {one} never changes in a compiled program: {why}
t-one-never-changes-in-a-compiled-program-why-438f0dd9 = { $one } 在编译后的程序中从不变化：{ $why }

# one too many
t-one-too-many-671c2b84 = 多出的一个

# out of range
t-out-of-range-855049b5 = 超出范围

# `{output}` sends pulses and gives their direction
t-output-sends-pulses-and-gives-their-direction-fdcf5d01 = `{ $output }` 既发出脉冲，又给出脉冲的方向

# overwrites part of `{first}` to `{last}`
t-overwrites-part-of-first-to-last-a9e34f52 = 覆盖 `{ $first }`～`{ $last }` 的一部分

# `P63` cannot be called
t-p63-cannot-be-called-a47c2e7f = 不能调用 `P63`

# P63 is the end of the program
t-p63-is-the-end-of-the-program-f05f4be4 = P63 是程序的结尾

# `P63` must not be defined
t-p63-must-not-be-defined-79f37b7a = 不得定义 `P63`

# port with a free protocol
t-port-with-a-free-protocol-c92a241f = 自由协议端口

# programs write it while COM{port} is {title}
t-programs-write-it-while-com-port-is-title-bee7213b = COM{ $port } 为 { $title } 时，由程序写入它

# `{pulse}` runs once each time its contacts close
t-pulse-runs-once-each-time-its-contacts-close-d02c7d28 = 触点每次接通时，`{ $pulse }` 只执行一次

# put a label before it, or move it before FEND
t-put-a-label-before-it-or-move-it-a8a4b68a = 在它前面加标号，或把它移到 FEND 之前

# put EI at the start of the program
t-put-ei-at-the-start-of-the-program-8781c678 = 在程序开头加 EI

# put {end} before FEND
t-put-end-before-fend-bcb49639 = 在 FEND 之前加 { $end }

# put LD M8000 before it to run it always
t-put-ld-m8000-before-it-to-run-it-7103ce09 = 需要始终执行时，在前面加 LD M8000

# put MPP before the last coil of the branch, or delete this MPS
t-put-mpp-before-the-last-coil-of-the-b9380d74 = 在分支的最后一个线圈前加 MPP，或删除此 MPS

# put RET after the last state
t-put-ret-after-the-last-state-e683f56d = 在最后一个状态之后加 RET

# put the {end} before this
t-put-the-end-before-this-b7d1721d = 把 { $end } 放在此处之前

# put the line `{device}` where the jump or call should go
t-put-the-line-device-where-the-jump-or-940309a3 = 在跳转或调用应到达的位置加一行 `{ $device }`

# put the routine `{device}` after FEND, with IRET at its end
t-put-the-routine-device-after-fend-with-iret-32f8bb06 = 把中断程序 `{ $device }` 放在 FEND 之后，以 IRET 结尾

# put the whole loop between PROC and PEND
t-put-the-whole-loop-between-proc-and-pend-85ee823e = 把整个循环放在 PROC 和 PEND 之间

# read here …
t-read-here-e7233285 = 在此处读取...

# read here
t-read-here-fb7c38f9 = 在此处读取

# read here: nothing but the program changes it
t-read-here-nothing-but-the-program-changes-it-d029033a = 在此处读取：除程序外没有任何东西改变它

# read with `{lower}` as a 32-bit value
t-read-with-lower-as-a-32-bit-value-ff8c094f = 与 `{ $lower }` 一起作为 32 位数据读取

# reads as 0
t-reads-as-0-f16e9ee2 = 读出值为 0

# `{register}` is {value}: {what} of {link} are {least} to {most}
t-register-is-value-what-of-link-are-least-5750c84b = `{ $register }` 为 { $value }：{ $link }的{ $what }为 { $least }～{ $most }

# `{register}` written here
t-register-written-here-5759b69b = `{ $register }` 在此处写入

# `{relay}` catches no pulse: there is no EI
t-relay-catches-no-pulse-there-is-no-ei-29efcef4 = `{ $relay }` 捕捉不到脉冲：程序中没有 EI

# requests an interrupt here …
t-requests-an-interrupt-here-000acca9 = 在此处请求中断...

# returns to the branch
t-returns-to-the-branch-30d458fe = 在此返回分支

# rising
t-rising-6d9323fb = 上升

# routines of other interrupts end with IRET
t-routines-of-other-interrupts-end-with-iret-56037982 = 其他中断的程序以 IRET 结束

# `rungc book links` describes the frames
t-rungc-book-links-describes-the-frames-5cf7baab = 帧格式见 `rungc book links`

# runs in every scan
t-runs-in-every-scan-7c386d96 = 每次扫描都执行

# {self} is a {protocol} with station {station}; stations are {least} to {most}
t-self-is-a-protocol-with-station-station-stations-41655f3b = { $self } 设为「{ $protocol }」，站号为 { $station }；站号应为 { $least }～{ $most }

# {self} is set up in two ways
t-self-is-set-up-in-two-ways-94d1d205 = { $self } 有两种不同的设定

# {self} {is} the {protocol}: {partners} have to run programs of rungc, too
t-self-is-the-protocol-partners-have-to-run-1e13a2ac = { $self } { $is }「{ $protocol }」：{ $partners }也必须运行 rungc 的程序

# {self} works through a Modbus table, which has no rows
t-self-works-through-a-modbus-table-which-has-ae4fe7b0 = { $self } 按 Modbus 表工作，而表中没有行

# sends no pulses
t-sends-no-pulses-f5e5abcb = 不输出脉冲

# serve by Modbus TCP with `--modbus-tcp 502` or `modbus-tcp = 502` in `[serve]` of rungc.toml
t-serve-by-modbus-tcp-with-modbus-tcp-502-43387490 = 用 `--modbus-tcp 502`，或 rungc.toml 的 `[serve]` 中的 `modbus-tcp = 502`，提供 Modbus TCP 服务

# set here
t-set-here-29d6cc7f = 在此处置位

# set it under `LD M8002` or `LD M8000`
t-set-it-under-ld-m8002-or-ld-m8000-11b20103 = 用 `LD M8002` 或 `LD M8000` 驱动此设定

# set `{register}` to its station
t-set-register-to-its-station-8f3199bf = 把 `{ $register }` 设为它的站号

# set up like this here …
t-set-up-like-this-here-4675ccd1 = 在此处这样设定...

# slave
t-slave-bc809d40 = 从站

# slave of a computer link
t-slave-of-a-computer-link-ff156611 = 计算机链接从站

# so does this
t-so-does-this-5f2359d4 = 此处也是如此

# some stop at programs with {areas}; use lower numbers, or try it on the board
t-some-stop-at-programs-with-areas-use-lower-77587c19 = 有些会因程序含有 { $areas } 而停止；改用更小的编号，或在实际的工控板上试运行

# split the flow into several initial states
t-split-the-flow-into-several-initial-states-7ddcc5f0 = 把流程拆分到多个初始状态

# start it with LD, LDI, LDP or LDF
t-start-it-with-ld-ldi-ldp-or-ldf-45a8e0c0 = 用 LD、LDI、LDP 或 LDF 开始

# start the table at another device, or use data registers
t-start-the-table-at-another-device-or-use-b4a9450c = 让表从其他软元件开始，或使用数据寄存器

# starts again here
t-starts-again-here-d2093fce = 在此处再次开始

# starts, and stops in the next scan
t-starts-and-stops-in-the-next-scan-e38c79ee = 启动后在下一次扫描中停止

# starts before FEND
t-starts-before-fend-962ed20e = 在 FEND 之前开始

# starts here and never ends
t-starts-here-and-never-ends-c23ad401 = 从这里开始，但没有结束

# stations of slaves
t-stations-of-slaves-a137327b = 从站的站号

# step ladder
t-step-ladder-1f505631 = 步进梯形图

# stored here
t-stored-here-f2132b4c = 在此存入

# subroutine
t-subroutine-8b177013 = 子程序

# swap the operands
t-swap-the-operands-d24680a5 = 交换两个操作数

# … that starts here
t-that-starts-here-a089b129 = { "." }..它从这里开始

# the 32-bit values at `{device}` and `{next}` share `{next}`
t-the-32-bit-values-at-device-and-next-f40d9a84 = `{ $device }` 和 `{ $next }` 处的 32 位数据共用 `{ $next }`

# the advanced interrupts are I900 to I907
t-the-advanced-interrupts-are-i900-to-i907-b7f36f8e = 高级中断为 I900～I907

# the branch starts here
t-the-branch-starts-here-827ae4bd = 分支从这里开始

# the CAN card is on CANlink: its partners have to run programs of rungc, too
t-the-can-card-is-on-canlink-its-partners-fcfe19f3 = CAN 卡使用 CANlink：其通信对象也必须执行 rungc 的程序

# the chain starts here
t-the-chain-starts-here-fa540540 = 调用链从这里开始

# the first branch
t-the-first-branch-b108baae = 第一个分支

# the first device of the range comes after the last
t-the-first-device-of-the-range-comes-after-eaab46f5 = 范围的首软元件位于末软元件之后

# the first of them
t-the-first-of-them-9c4eadeb = 其中的第一个

# the first one
t-the-first-one-ff15d136 = 第一个中断程序

# the first one is here
t-the-first-one-is-here-793dcf54 = 第一个在这里

# the first one starts here
t-the-first-one-starts-here-5ae35b07 = 第一个从这里开始

# the format word H{word} of {port} names no bit rate
t-the-format-word-h-word-of-port-names-f47b70ed = { $port } 的通信格式 H{ $word } 没有指定波特率

# the host that runs the program must do what it does on the PLC
t-the-host-that-runs-the-program-must-do-4f7ca491 = 运行程序的宿主程序必须完成它在 PLC 上的功能

# the last instruction
t-the-last-instruction-e1537db4 = 最后一条指令

# the last of these branches
t-the-last-of-these-branches-58611f1e = 这些分支中的最后一个

# the last return to it
t-the-last-return-to-it-3f452224 = 最后一次返回此分支

# the main program ends here …
t-the-main-program-ends-here-1030303d = 主程序在此处结束...

# the manuals do not print the frames of CANlink
t-the-manuals-do-not-print-the-frames-of-77a5303c = 手册没有给出 CANlink 的帧格式

# the manuals do not print the frames of this link
t-the-manuals-do-not-print-the-frames-of-c3aa7692 = 手册没有给出此链接的帧格式

# the model's own are used
t-the-model-s-own-are-used-e43cdbe2 = 使用机型自身的停电保持范围

# the module ignores it
t-the-module-ignores-it-5d6d0928 = 模块忽略此写入

# the next block starts here
t-the-next-block-starts-here-28082809 = 下一个回路块从这里开始

# the ninth block
t-the-ninth-block-6faf5380 = 第九个回路块

# the others are latched; `{wrong}` is the first that is not
t-the-others-are-latched-wrong-is-the-first-3eb836a3 = 其余的为停电保持；第一个不能保持的是 `{ $wrong }`

# the outermost loop
t-the-outermost-loop-da9ded62 = 最外层的循环

# the {outside} ends inside the {within}
t-the-outside-ends-inside-the-within-f72cc2cb = { $outside }在{ $within }之内结束

# the parameters latch {range}, but {name} cannot latch all of them
t-the-parameters-latch-range-but-name-cannot-latch-dd30a69e = 参数把 { $range } 设为停电保持，但 { $name } 不能保持其中的全部

# the parameters latch {range}, but the latched devices of {name} are fixed
t-the-parameters-latch-range-but-the-latched-devices-3baf5c9b = 参数把 { $range } 设为停电保持，但 { $name } 的停电保持软元件是固定的

# the parameters set a memory of {steps} steps, but {model} has {memory_steps}
t-the-parameters-set-a-memory-of-steps-steps-02c76d78 = 参数设定的程序存储器为 { $steps } 步，但 { $model } 只有 { $memory_steps } 步

# the PLC is both master and slave of a parallel link
t-the-plc-is-both-master-and-slave-of-2daef381 = PLC 同时是并联链接的主站和从站

# the port is set up here
t-the-port-is-set-up-here-1ee04a68 = 端口在此处设定

# the port runs at 9600 bit/s
t-the-port-runs-at-9600-bit-s-cfb293b6 = 端口以 9600 bit/s 运行

# the program does not end with END
t-the-program-does-not-end-with-end-b92e8ffa = 程序没有以 END 结束

# the program is empty
t-the-program-is-empty-3e56cc99 = 程序为空

# the project says RETAIN
t-the-project-says-retain-a0c38014 = 工程中声明为 RETAIN

# the result of this block is lost
t-the-result-of-this-block-is-lost-ce386965 = 此回路块的运算结果丢失

# the routine is left or entered here …
t-the-routine-is-left-or-entered-here-15fda89d = 在此处离开或进入中断程序...

# the scan ends here
t-the-scan-ends-here-f55206c1 = 扫描在这里结束

# the second routine of this source
t-the-second-routine-of-this-source-74bfebac = 此中断源的第二个中断程序

# the state `{state}` occurs twice
t-the-state-state-occurs-twice-ff76907b = 状态 `{ $state }` 重复出现

# the subroutine starts here
t-the-subroutine-starts-here-f84146bf = 子程序从这里开始

# the table does not change
t-the-table-does-not-change-6f2d7a60 = 表不会改变

# the table of ABSD starts at `{device}`, no multiple of 8
t-the-table-of-absd-starts-at-device-no-c3fc9387 = ABSD 的表从 `{ $device }` 开始，编号不是 8 的倍数

# the twelfth MPS
t-the-twelfth-mps-8b589618 = 第十二个 MPS

# there is no block before it
t-there-is-no-block-before-it-af368b47 = 前面没有回路块

# there is no STL before it
t-there-is-no-stl-before-it-ed230953 = 它前面没有 STL

# there is nothing to end
t-there-is-nothing-to-end-de1137fa = 没有可以结束的内容

# there is nothing to repeat
t-there-is-nothing-to-repeat-0d2630ba = 没有可以循环的内容

# there is only one block before it
t-there-is-only-one-block-before-it-180a734a = 前面只有一个回路块

# these contacts drive nothing
t-these-contacts-drive-nothing-24ca0e10 = 这些触点没有驱动任何线圈或指令

# these instructions never run
t-these-instructions-never-run-e6498b1a = 这些指令从不执行

# this and everything after it never runs
t-this-and-everything-after-it-never-runs-acabbb74 = 此处及其后的内容从不执行

# this block is still open
t-this-block-is-still-open-c33f6ae2 = 此回路块尚未连接

# this call is skipped with error 6702 when it is reached
t-this-call-is-skipped-with-error-6702-when-a53c330f = 此调用执行到时被跳过，错误代码为 6702

# this call re-enters its own subroutine
t-this-call-re-enters-its-own-subroutine-dce6d8a4 = 此调用再次进入自身所在的子程序

# this interrupt routine
t-this-interrupt-routine-d2f21272 = 此中断程序

# this interrupt routine never runs: there is no EI
t-this-interrupt-routine-never-runs-there-is-no-6aec06cd = 此中断程序从不执行：程序中没有 EI

# this is `{device}` and `{next}`
t-this-is-device-and-next-ba28b727 = 此数据占用 `{ $device }` 和 `{ $next }`

# this is fine if an operator panel or another program resets it; then name it in `[hmi] writes` of rungc.toml
t-this-is-fine-if-an-operator-panel-or-4c9c8a17 = 如果由人机界面或其他程序复位，则没有问题；此时在 rungc.toml 的 `[hmi] writes` 中写明它

# this is fine if an operator panel or another program reads it; then name it in `[hmi] reads` of rungc.toml
t-this-is-fine-if-an-operator-panel-or-64dd85dd = 如果由人机界面或其他程序读取，则没有问题；此时在 rungc.toml 的 `[hmi] reads` 中写明它

# this is fine if an operator panel or another program reads them; then name them in `[hmi] reads` of rungc.toml
t-this-is-fine-if-an-operator-panel-or-89b0c3bd = 如果由人机界面或其他程序读取，则没有问题；此时在 rungc.toml 的 `[hmi] reads` 中写明它们

# this is fine if an operator panel or another program writes it; then name it in `[hmi] writes` of rungc.toml
t-this-is-fine-if-an-operator-panel-or-8d087723 = 如果由人机界面或其他程序写入，则没有问题；此时在 rungc.toml 的 `[hmi] writes` 中写明它

# this is fine if an operator panel or another program resets them; then name them in `[hmi] writes` of rungc.toml
t-this-is-fine-if-an-operator-panel-or-9e2eb377 = 如果由人机界面或其他程序复位，则没有问题；此时在 rungc.toml 的 `[hmi] writes` 中写明它们

# this is fine if an operator panel or another program writes them; then name them in `[hmi] writes` of rungc.toml
t-this-is-fine-if-an-operator-panel-or-a1d6eae3 = 如果由人机界面或其他程序写入，则没有问题；此时在 rungc.toml 的 `[hmi] writes` 中写明它们

# this is `{next}` and the next register
t-this-is-next-and-the-next-register-cc95b9b8 = 此数据占用 `{ $next }` 和下一个寄存器

# this jump goes into a loop
t-this-jump-goes-into-a-loop-d7b7e9b2 = 此跳转进入循环

# this jump goes into another routine
t-this-jump-goes-into-another-routine-471841a4 = 此跳转进入另一个子程序或中断程序

# this jump has no condition that could be off
t-this-jump-has-no-condition-that-could-be-3758090b = 此跳转没有可能断开的条件

# this jump leaves or enters a state of a step ladder
t-this-jump-leaves-or-enters-a-state-of-cb95228d = 此跳转离开或进入步进梯形图的状态

# this {kind} is in the main program
t-this-kind-is-in-the-main-program-37c6c6da = 此{ $kind }位于主程序中

# this MPP closed the branch
t-this-mpp-closed-the-branch-5e5689af = 此 MPP 结束了分支

# this {name} has no {end}
t-this-name-has-no-end-c14ba330 = 此{ $name }缺少 { $end }

# this never runs
t-this-never-runs-c811005b = 此处从不执行

# … this one
t-this-one-62077c3d = { "." }..这是外层区间

# … this one is overwritten
t-this-one-is-overwritten-622fc3ce = { "." }..此值被覆盖

# this value counts …
t-this-value-counts-9c7f08e8 = 此值有效...

# this {within}
t-this-within-3473aef6 = 此{ $within }

# this zone is inside …
t-this-zone-is-inside-dd37af99 = 此区间位于另一区间之内...

# timer interrupt I{number} has two periods
t-timer-interrupt-i-number-has-two-periods-37866ae9 = 定时中断 I{ $number } 有两个周期

# `{timer}` is driven in `{state}` and in `{next}`, which follows it
t-timer-is-driven-in-state-and-in-next-60c84e8f = `{ $timer }` 既在 `{ $state }` 中驱动，又在其后的 `{ $next }` 中驱动

# ; {timers} do so too: they count 1 ms and keep their value until RST
t-timers-do-so-too-they-count-1-ms-61ae00a9 = ；{ $timers } 也是如此：以 1 ms 为单位计时，并把当前值保持到 RST

# {title} sends no pulses at `{device}`
t-title-sends-no-pulses-at-device-fa01987a = { $title } 不能在 `{ $device }` 上发出脉冲

# … to here
t-to-here-36f7735e = { "." }..跳到此处

# … to here …
t-to-here-42fa5bfa = { "." }..跳到此处...

# twice
t-twice-b4a7d5f3 = 在两处

# two comparisons use compare zone {zone} at the same time
t-two-comparisons-use-compare-zone-zone-at-the-8a8f6fb8 = 两条比较指令同时使用比较区 { $zone }

# two instructions make tables at the same time
t-two-instructions-make-tables-at-the-same-time-f7f1722a = 两条指令同时制表

# two instructions move axis {axis} at the same time
t-two-instructions-move-axis-axis-at-the-same-9ed5f100 = 两条指令同时驱动轴 { $axis } 运动

# two instructions send pulses through `{output}` at the same time
t-two-instructions-send-pulses-through-output-at-the-02c39629 = 两条指令同时通过 `{ $output }` 发出脉冲

# two interrupt routines use `{input}` (rising and falling edge)
t-two-interrupt-routines-use-input-rising-and-falling-839d95f6 = 两个中断程序使用 `{ $input }`（上升沿和下降沿）

# use a constant above {bound}
t-use-a-constant-above-bound-4a5c07d2 = 使用大于 { $bound } 的常数

# use a constant from {min} to {max}
t-use-a-constant-from-min-to-max-48ef8796 = 使用 { $min }～{ $max } 的常数

# use a register that is free for programs, from D1000 on
t-use-a-register-that-is-free-for-programs-3a7146a1 = 使用程序可以自由使用的寄存器，从 D1000 开始

# use a separate input
t-use-a-separate-input-55fafafc = 另用一个输入

# use a separate input, or set a relay in the interrupt routine
t-use-a-separate-input-or-set-a-relay-11cfd7e2 = 另用一个输入，或在中断程序中置位一个继电器

# use a separate one in each branch
t-use-a-separate-one-in-each-branch-c7bbfd2c = 每个分支使用单独的一个

# use a separate one in each place
t-use-a-separate-one-in-each-place-5fe3c71f = 每处使用单独的一个

# use an ordinary device instead of `{device}` if it is a flag or value of the program's own
t-use-an-ordinary-device-instead-of-device-if-4cc85eeb = 如果 `{ $device }` 是程序自用的标志或数据，改用普通软元件

# use an output from {first} on
t-use-an-output-from-first-on-78ae6109 = 使用从 { $first } 开始的输出

# use another number for this label
t-use-another-number-for-this-label-946c35e3 = 此标号改用其他编号

# use another timer in one of the two states
t-use-another-timer-in-one-of-the-two-b25c118b = 两个状态之一改用其他定时器

# use at most {max} with a word
t-use-at-most-max-with-a-word-04ede7d1 = 使用字元件时最大取 { $max }

# use CALL to run a subroutine, SRET to leave one
t-use-call-to-run-a-subroutine-sret-to-993c71b3 = 执行子程序用 CALL，离开子程序用 SRET

# use counters with different inputs
t-use-counters-with-different-inputs-85d6724f = 使用输入不同的计数器

# use `{kind}` or more
t-use-kind-or-more-e36f2958 = 使用 `{ $kind }` 或更大的值

# use {min} or more
t-use-min-or-more-e4df69e0 = 使用 { $min } 或更大的值

# use one of them, or modules beside the main unit
t-use-one-of-them-or-modules-beside-the-956c61e7 = 只使用其中之一，或使用主模块旁的模块

# use only SET and RST, or one OUT with all conditions
t-use-only-set-and-rst-or-one-out-2f819fb8 = 只用 SET 和 RST，或用一个 OUT 合并所有条件

# use registers below D7000
t-use-registers-below-d7000-c72de838 = 使用 D7000 之前的寄存器

# use separate registers for each value
t-use-separate-registers-for-each-value-12148c90 = 每个数据使用单独的寄存器

# used here …
t-used-here-c53f854a = 在此处使用...

# {variant} does not have `{device}`
t-variant-does-not-have-device-c2c551de = { $variant } 没有 `{ $device }`

# {variant} does not have `{inst}`
t-variant-does-not-have-inst-5afcbc24 = { $variant } 没有 `{ $inst }`

# {wanted} is wanted here …
t-wanted-is-wanted-here-c485b2fb = 此处要求「{ $wanted }」...

# what this writes …
t-what-this-writes-b837df9b = 此处写入的结果...

# , which is H{value} at power-on,
t-which-is-h-value-at-power-on-68804917 = （上电时为 H{ $value }）

# which starts here
t-which-starts-here-4c1220f3 = 此回路块从这里开始

# … while this sends pulses through it
t-while-this-sends-pulses-through-it-7f809b11 = { "." }..而此处通过它发出脉冲

#  with `{device}`
t-with-device-81662853 = （配合 `{ $device }`）

# write ANB or ORB after each block instead of all at the end
t-write-anb-or-orb-after-each-block-instead-98cde7a6 = 在每个回路块之后写 ANB 或 ORB，不要全部留到最后

# write it in one place, or use another device
t-write-it-in-one-place-or-use-another-ee636528 = 只在一处写入，或使用其他软元件

# write `MCR N{open}`
t-write-mcr-n-open-5db27ccc = 改为 `MCR N{ $open }`

# write {mnemonic}
t-write-mnemonic-0cd6832c = 改为 { $mnemonic }

# write `{mnemonic} {last} {first}`
t-write-mnemonic-last-first-c715a574 = 改为 `{ $mnemonic } { $last } { $first }`

# write MPP for the last return to a branch
t-write-mpp-for-the-last-return-to-a-8f4f62d3 = 最后一次返回分支时，用 MPP

# write MRD to return to a branch that continues
t-write-mrd-to-return-to-a-branch-that-dee0fdbd = 返回还要继续的分支时，用 MRD

# write the pulse form
t-write-the-pulse-form-972982ec = 改为脉冲执行型

# write the rows of the editor's table to rungc.toml, as `[[modbus]]`
t-write-the-rows-of-the-editor-s-table-99010dbd = 把编程软件中表的各行以 `[[modbus]]` 写入 rungc.toml

# write {values} to `D{n}` in the first scan
t-write-values-to-d-n-in-the-first-6fa276e6 = 在第一次扫描中把 { $values } 写入 `D{ $n }`

# `{writer}` writes `{first}` to `{last}`
t-writer-writes-first-to-last-bb9441b5 = `{ $writer }` 写入 `{ $first }`～`{ $last }`

# writes the output in every scan …
t-writes-the-output-in-every-scan-5d4b4216 = 每次扫描都写入此输出...

# written here
t-written-here-de95a7fe = 在此处写入

# … written here …
t-written-here-fd4ccc26 = { "." }..在此处写入...

# written here: nothing depends on it but the program
t-written-here-nothing-depends-on-it-but-the-5db920c8 = 在此处写入：除程序外没有任何东西依赖它

# written here too
t-written-here-too-60f4f8b0 = 此处也写入

# written with `{lower}` as a 32-bit value
t-written-with-lower-as-a-32-bit-value-12c477b4 = 与 `{ $lower }` 一起作为 32 位数据写入
