# ({condition})
t-condition-a62cde07 = （{ $condition }）

# A register decides how many devices it writes from {first} on.
t-a-register-decides-how-many-devices-it-writes-5aa1c7fe = 由寄存器决定从 { $first } 起写入多少个软元件。

# For it to {change}, no way was searched for: {reason}.
t-for-it-to-change-no-way-was-searched-8726c491 = 未搜索使其{ $change }的方法：{ $reason }。

# For it to {change}:
t-for-it-to-change-d68e3610 = 要使其{ $change }：

# Index {index} selects the devices: it may be another one.
t-index-index-selects-the-devices-it-may-be-b58431a2 = 由变址寄存器 { $index } 选择软元件：可能是另一个。

# It and {name} hold each other.
t-it-and-name-hold-each-other-4185ddd4 = 它与 { $name } 互相保持。

# It holds itself.
t-it-holds-itself-1a1e01e9 = 它自保持。

# No scan reaches it: nothing calls or jumps to it.
t-no-scan-reaches-it-nothing-calls-or-jumps-4aeead85 = 没有扫描能执行到它：没有调用或跳转指向它。

# No way for it to {change} was found, in {count} states that these lead to, with waits of up to {time}: {devices}.
t-no-way-for-it-to-change-was-found-3802110f = 未找到使其{ $change }的方法；改变 { $devices } 所能到达的 { $count } 个状态均已查过，等待时间最长 { $time }。

# Not tried: {count} devices that are farther away.
t-not-tried-count-devices-that-are-farther-away-908e162d = 未尝试：另有 { $count } 个较远的软元件。

# The PLC is in STOP: no instruction is executed.
t-the-plc-is-in-stop-no-instruction-is-0b6c2ae4 = PLC 处于 STOP：不执行任何指令。

# The next scan switches it {state}.
t-the-next-scan-switches-it-state-932052ac = 下一次扫描将其变为 { $state }。

# The program jumps backwards or leaves a routine early: what that passes over is not followed.
t-the-program-jumps-backwards-or-leaves-a-routine-b9acfc93 = 程序向后跳转或提前离开子程序：被跳过的部分不追踪。

# Then {name} comes on.
t-then-name-comes-on-7b673f4f = 于是 { $name } 变为 ON。

# Then {name} does.
t-then-name-does-475216fa = 于是 { $name } 便如此。

# Then {name} goes off.
t-then-name-goes-off-f2a3c238 = 于是 { $name } 变为 OFF。

# There are more states: the search has a limit.
t-there-are-more-states-the-search-has-a-cd034059 = 还有更多状态：搜索有上限。

# a way is searched for bits alone
t-a-way-is-searched-for-bits-alone-d8c23a80 = 只对位软元件搜索方法

# always
t-always-6736afe4 = 始终

# an edge
t-an-edge-e89e45eb = 边沿

# another result of {instruction}
t-another-result-of-instruction-faf9dce8 = { $instruction } 的另一个结果

# another result than {result}
t-another-result-than-result-380ab377 = 不同于{ $result }的结果

# at {edge} a change: off, then on again
t-at-edge-a-change-off-then-on-again-9837fbb5 = { $edge } 处的变化：先 OFF，再 ON

# at {edge} a change: on, then off again
t-at-edge-a-change-on-then-off-again-6b72b8e5 = { $edge } 处的变化：先 ON，再 OFF

# because {reasons}.
t-because-reasons-96025314 = 原因：{ $reasons }。

# by other values
t-by-other-values-e91e2e20 = 由其他值决定

# come on
t-come-on-f85b0cee = 变为 ON

# driven: {condition}
t-driven-condition-ca9519aa = 驱动条件：{ $condition }

# executed: {condition}
t-executed-condition-e8732f4f = 执行条件：{ $condition }

# go off
t-go-off-dd772e36 = 变为 OFF

# it
t-it-47388410 = 该软元件

# its state in the scan before
t-its-state-in-the-scan-before-b520dfb4 = 其上一次扫描的状态

# never
t-never-0ac95089 = 从不

# not in the recording, and taken for off or 0: {devices}
t-not-in-the-recording-and-taken-for-off-45ce5381 = 记录中没有、视为 OFF 或 0 的软元件：{ $devices }

# not shown by the port of the PLC, and taken for off or 0: {devices}
t-not-shown-by-the-port-of-the-plc-7af727f5 = PLC 的端口不显示、视为 OFF 或 0 的软元件：{ $devices }

# not to be driven
t-not-to-be-driven-20fa3d06 = 要不被驱动

# not {condition}
t-not-condition-e88b434f = 非 { $condition }

# off
t-off-ab3a8a0a = OFF

# on
t-on-61342fd0 = ON

# or one more
t-or-one-more-3b0be721 = 或另外一种

# or others
t-or-others-3518abb7 = 或其他

# or {count} more
t-or-count-more-69fc0594 = 或另外 { $count } 种

# send no pulses and go off
t-send-no-pulses-and-go-off-cd10628c = 停止输出脉冲并变为 OFF

# send pulses or come on
t-send-pulses-or-come-on-72ff6185 = 输出脉冲或变为 ON

# the PLC is in STOP
t-the-plc-is-in-stop-a8b0268a = PLC 处于 STOP

# the input of {edge} was off in the scan before
t-the-input-of-edge-was-off-in-the-8ca3b774 = { $edge } 的输入在上一次扫描中为 OFF

# the input of {edge} was on in the scan before
t-the-input-of-edge-was-on-in-the-bd6b499e = { $edge } 的输入在上一次扫描中为 ON

# the program in the PLC is another one, from step {step} on
t-the-program-in-the-plc-is-another-one-ddb26695 = PLC 中的程序与本程序从步 { $step } 起不同

# the program in the PLC is this program
t-the-program-in-the-plc-is-this-program-73516015 = PLC 中的程序就是本程序

# the result of the PLC
t-the-result-of-the-plc-6b61c6a0 = PLC 的结果

# the result of {instruction}
t-the-result-of-instruction-8e9afb60 = { $instruction } 的结果

# this program cannot be compared with that in the PLC: machine code of its instructions is not known
t-this-program-cannot-be-compared-with-that-in-c3c664b6 = 本程序无法与 PLC 中的程序比较：其指令的机器码未知

# to be driven
t-to-be-driven-f4d26679 = 要被驱动

# to come on
t-to-come-on-daaf44cd = 要变为 ON

# to go off
t-to-go-off-48c225ab = 要变为 OFF

# wait {time}
t-wait-time-6eb8ea3f = 等待 { $time }

# {action}: {changes}
t-action-changes-9d21b166 = { $action }：{ $changes }

# {a} and {b}
t-a-and-b-1d2ba6ed = { $a } 且 { $b }

# {a} or {b}
t-a-or-b-c75e7329 = { $a } 或 { $b }

# {change}, it needs one of
t-change-it-needs-one-of-cb469e32 = { $change }，需要下列之一：

# {change}, it needs {needed}
t-change-it-needs-needed-eb9c89cc = { $change }，需要：{ $needed }

# {comparison} does not hold ({values})
t-comparison-does-not-hold-values-59ae09f8 = { $comparison } 不成立（{ $values }）

# {comparison} holds ({values})
t-comparison-holds-values-de78d4d9 = { $comparison } 成立（{ $values }）

# {condition} coming on
t-condition-coming-on-6013ea02 = { $condition } 的上升沿

# {condition} going off
t-condition-going-off-e3549e4d = { $condition } 的下降沿

# {counter} has counted to its preset ({progress})
t-counter-has-counted-to-its-preset-progress-281e8ff7 = { $counter } 已计数到设定值（{ $progress }）

# {counter} has not counted to its preset ({progress})
t-counter-has-not-counted-to-its-preset-progress-be93c2c0 = { $counter } 未计数到设定值（{ $progress }）

# {instruction}  (network {network}, step {step})
t-instruction-network-network-step-step-0fde9020 = { $instruction }（网络 { $network }，步 { $step }）

# {instruction} (step {step})
t-instruction-step-step-2afab17e = { $instruction }（步 { $step }）

# {instruction} through index {index} writes {written}, which cannot be followed
t-instruction-through-index-index-writes-written-which-cannot-abf1e23e = { $instruction } 通过变址寄存器 { $index } 写入 { $written }，无法继续追踪

# {instruction} writes {written}, which cannot be followed
t-instruction-writes-written-which-cannot-be-followed-4a8c83df = { $instruction } 写入 { $written }，无法继续追踪

# {name} = {value}
t-name-value-51e7145e = { $name } = { $value }

# {name} came on
t-name-came-on-002963b7 = { $name } 变为 ON

# {name} comes on
t-name-comes-on-74116c82 = { $name } 变为 ON

# {name} counting on
t-name-counting-on-312df30a = { $name } 继续计数

# {name} depends on it in turn.
t-name-depends-on-it-in-turn-b8c187db = { $name } 反过来又取决于它。

# {name} goes off
t-name-goes-off-701b82bb = { $name } 变为 OFF

# {name} has {count} coils, at steps {steps}: the last one that is executed decides.
t-name-has-count-coils-at-steps-steps-the-a91c3dc8 = { $name } 有 { $count } 个线圈，位于步 { $steps }：由最后执行的一个决定。

# {name} having counted to its preset
t-name-having-counted-to-its-preset-dc258079 = { $name } 计数到设定值

# {name} having run its time
t-name-having-run-its-time-9adaef2f = { $name } 计时到

# {name} is a special device: `rungc explain {device}` describes it.
t-name-is-a-special-device-rungc-explain-device-dcf41251 = { $name } 是特殊软元件：说明见 `rungc explain { $device }`。

# {name} is an input: its terminal decides.
t-name-is-an-input-its-terminal-decides-a78ed178 = { $name } 是输入：由其端子决定。

# {name} is not written by any instruction: only something outside the program changes it.
t-name-is-not-written-by-any-instruction-only-c22fd55d = 没有指令写入 { $name }：只有程序以外的操作能改变它。

# {name} is reset, and nothing sets it.
t-name-is-reset-and-nothing-sets-it-2a88d04f = { $name } 被复位，但没有指令将其置位。

# {name} is set, and no RST resets it.
t-name-is-set-and-no-rst-resets-it-675deefe = { $name } 被置位，但没有 RST 将其复位。

# {name} is written by one instruction.
t-name-is-written-by-one-instruction-af47e91e = { $name } 由一条指令写入。

# {name} is written by {count} instructions.
t-name-is-written-by-count-instructions-3a0ec796 = { $name } 由 { $count } 条指令写入。

# {name} is {state}
t-name-is-state-a00759b1 = { $name } 为 { $state }

# {name} is {state}: an input.
t-name-is-state-an-input-5bc5c456 = { $name } 为 { $state }：输入。

# {name} is {state}: it is forced.
t-name-is-state-it-is-forced-25565bd3 = { $name } 为 { $state }：被强制。

# {name} is {state}: no instruction writes it.
t-name-is-state-no-instruction-writes-it-01b6f855 = { $name } 为 { $state }：没有指令写入它。

# {name} is {state}: the PLC drives it.
t-name-is-state-the-plc-drives-it-60464275 = { $name } 为 { $state }：由 PLC 驱动。

# {name} is {state}: {place}.
t-name-is-state-place-8475cc54 = { $name } 为 { $state }：{ $place }。

# {name} keeps its state over power-off.
t-name-keeps-its-state-over-power-off-f67eaeee = { $name } 停电保持其状态。

# {name} not having run its time
t-name-not-having-run-its-time-f6bee862 = { $name } 未计时到

# {name} on, and off again
t-name-on-and-off-again-f04bb533 = { $name } 变为 ON，再变为 OFF

# {name} on, and off again: {times} times
t-name-on-and-off-again-times-times-52effab9 = { $name } 变为 ON，再变为 OFF：{ $times } 次

# {name} sends pulses: whether it is on or off between two of them is not followed.
t-name-sends-pulses-whether-it-is-on-or-0e836868 = { $name } 输出脉冲：两个脉冲之间的 ON 或 OFF 不追踪。

# {name} stays {state}: no instruction writes it in this scan.
t-name-stays-state-no-instruction-writes-it-in-a2c824bf = { $name } 保持 { $state }：本次扫描中没有指令写入它。

# {name} stays {state}: {place} is not driven.
t-name-stays-state-place-is-not-driven-a6fb9159 = { $name } 保持 { $state }：{ $place }未被驱动。

# {name} stays {state}: {place} is not executed.
t-name-stays-state-place-is-not-executed-35d94e00 = { $name } 保持 { $state }：{ $place }未被执行。

# {name} went off
t-name-went-off-da170bcf = { $name } 变为 OFF

# {name} {state}
t-name-state-78ef74b1 = { $name } 为 { $state }

# {needed} in the scan before
t-needed-in-the-scan-before-59705f76 = 上一次扫描中 { $needed }

# {number}. {action}
t-number-action-bd5615ca = { $number }. { $action }

# {others} and {last}
t-others-and-last-9ae1a22b = { $others } 和 { $last }

# {place} is driven.
t-place-is-driven-263428f4 = { $place }已被驱动。

# {place} is not driven.
t-place-is-not-driven-eedea291 = { $place }未被驱动。

# {relay} is on: the terminals of all outputs are off.
t-relay-is-on-the-terminals-of-all-outputs-4711738a = { $relay } 为 ON：所有输出端子均断开。

# {state} at {time}
t-state-at-time-61e97ce2 = { $time } 时 { $state }

# {state} in the PLC
t-state-in-the-plc-8d342abb = PLC 中 { $state }

# {state},
t-state-f157dfae = { $state }，

# {state}, since {time} (scan {scan})
t-state-since-time-scan-scan-87474300 = { $state }，自 { $time } 起（第 { $scan } 次扫描）

# {state}, when {changes}
t-state-when-changes-455807e7 = { $state }，当时 { $changes }

# {state}.
t-state-ef57dc88 = { $state }。

# {timer} has not run its time ({progress})
t-timer-has-not-run-its-time-progress-cb6ef517 = { $timer } 未计时到（{ $progress }）

# {timer} has run its time ({progress})
t-timer-has-run-its-time-progress-9d897a4a = { $timer } 已计时到（{ $progress }）

# {value} of {of}
t-value-of-of-d62f0b8a = { $value } / { $of }

# {value} of {of}, {left} to go
t-value-of-of-left-to-go-da966e70 = { $value } / { $of }，还差 { $left }
