# 1 operand
t-1-operand-14b43c39 = 1 个操作数

# 16-bit
t-16-bit-235f8134 = 16 位

# 32-bit
t-32-bit-5956b122 = 32 位

# a bit of a register cannot take an index register
t-a-bit-of-a-register-cannot-take-an-7b5c487e = 寄存器的位不能使用变址寄存器

# a coil is Y, M, S, T, C or a bit of a word (`D0.F`); use `MOV` to write a value to `{device}`
t-a-coil-is-y-m-s-t-c-06076c58 = 线圈为 Y、M、S、T、C 或字元件的位（`D0.F`）；要把值写入 `{ $device }`，使用 `MOV`

#  (a comparison is `{comparison}`)
t-a-comparison-is-comparison-d95420df = （比较写作 `{ $comparison }`）

# a constant cannot be written
t-a-constant-cannot-be-written-7f5969a7 = 常数不能写入

# a counter is a coil with its preset: `OUT C0 K10`
t-a-counter-is-a-coil-with-its-preset-3513ab6c = 计数器是带设定值的线圈：`OUT C0 K10`

# a jump is `CJ`, driven by contacts: `LD M8000`, `CJ P0`
t-a-jump-is-cj-driven-by-contacts-ld-4faec209 = 跳转是 `CJ`，由触点驱动：`LD M8000`、`CJ P0`

# a list has no statements: a condition is contacts before what they drive (`LD M0`, `OUT Y000`) or before a jump
t-a-list-has-no-statements-a-condition-is-abbf9915 = 指令表没有语句：条件是被驱动对象（`LD M0`、`OUT Y000`）或跳转之前的触点

# a second instruction, `{second}`, on one line
t-a-second-instruction-second-on-one-line-d92d2bad = 同一行中有第二条指令 `{ $second }`

# a space is missing: `{name} {words}`
t-a-space-is-missing-name-words-abbef988 = 缺少空格：`{ $name } { $words }`

# a subroutine ends with `SRET`
t-a-subroutine-ends-with-sret-8ed8955c = 子程序以 `SRET` 结束

# a subroutine is called with `CALL P0`
t-a-subroutine-is-called-with-call-p0-496a850d = 用 `CALL P0` 调用子程序

# a timer is a coil with its preset: `OUT T0 K30`
t-a-timer-is-a-coil-with-its-preset-022b30a2 = 定时器是带设定值的线圈：`OUT T0 K30`

# accepted: {kinds}
t-accepted-kinds-7f960849 = 可用的类型：{ $kinds }

# add the registers first, or use a data register
t-add-the-registers-first-or-use-a-data-850c758f = 先把寄存器相加，或使用数据寄存器

#  (and {n} more such steps after it)
t-and-n-more-such-steps-after-it-f5d9eb2b = （其后还有 { $n } 个这样的步号）

# at most K{max} with a group
t-at-most-k-max-with-a-group-e2817d86 = 使用位元件组合时最大为 K{ $max }

# available on: {names}
t-available-on-names-9fafa5ef = 支持的机型：{ $names }

# {before}`{boards}` takes it
t-before-boards-takes-it-d380a90e = { $before }`{ $boards }` 支持它

# {before} or {last}
t-before-or-last-79ca17d3 = { $before } 或 { $last }

# blocks are joined with `ANB` here
t-blocks-are-joined-with-anb-here-d127d1a3 = 此处用 `ANB` 连接电路块

# blocks are joined with `ORB` here
t-blocks-are-joined-with-orb-here-00ce2aa9 = 此处用 `ORB` 连接电路块

# C200 and up in the 32-bit form
t-c200-and-up-in-the-32-bit-form-52448d81 = 32 位形式使用 C200 及以上

# C200 to C234 count with 32 bits
t-c200-to-c234-count-with-32-bits-c46797a1 = C200～C234 以 32 位计数

# C200 to C255 hold 32 bits
t-c200-to-c255-hold-32-bits-bd0dd302 = C200～C255 为 32 位

# choose a larger memory capacity in the PLC parameters
t-choose-a-larger-memory-capacity-in-the-plc-950b423c = 在 PLC 参数中选择更大的存储器容量

# compare this step with the editor, or export the list from it and compile that
t-compare-this-step-with-the-editor-or-export-5477256a = 在编程软件中核对这一步，或从中导出指令表，再编译指令表

# comparisons are not negated: the opposite is `{right}`
t-comparisons-are-not-negated-the-opposite-is-right-e21ff70e = 比较不能取反：相反的比较是 `{ $right }`

# … conflicts with this
t-conflicts-with-this-4d842ebc = { "." }..与此处冲突

# `{device}` cannot be used here
t-device-cannot-be-used-here-121463ee = 此处不能使用 `{ $device }`

# `{device}` counts up to {seconds} s; for longer times, let the contact of one timer drive the next
t-device-counts-up-to-seconds-s-for-longer-90144630 = `{ $device }` 最多计时 { $seconds } s；需要更长的时间时，用一个定时器的触点驱动下一个定时器

# `{device}` does not exist: {model} has no {prefix}
t-device-does-not-exist-model-has-no-prefix-6677b164 = `{ $device }` 不存在：{ $model } 没有 { $prefix }

# `{device}` does not exist on {model} ({ranges})
t-device-does-not-exist-on-model-ranges-3adf2f77 = { $model } 没有 `{ $device }`（{ $ranges }）

# `{device}` has no bits that can be named like this
t-device-has-no-bits-that-can-be-named-c01ba316 = `{ $device }` 没有可以这样表示的位

# `{device}` is a 32-bit counter, `{mnemonic}` takes 16 bits
t-device-is-a-32-bit-counter-mnemonic-takes-fb90fac8 = `{ $device }` 是 32 位计数器，而 `{ $mnemonic }` 为 16 位

# `{device}` is a word; write one bit of it as `{device}.F`
t-device-is-a-word-write-one-bit-of-730d156b = `{ $device }` 是字元件；其中的一位写作 `{ $device }.F`

# `{device}` is an index register and cannot be indexed itself
t-device-is-an-index-register-and-cannot-be-72eca704 = `{ $device }` 是变址寄存器，自身不能变址

# `{device}` is one bit; write a group of {bits} bits as `{grouped}`
t-device-is-one-bit-write-a-group-of-039a88c7 = `{ $device }` 是一个位；{ $bits } 位的位元件组合写作 `{ $grouped }`

# `{device}` is only the upper half of the operand of `{mnemonic}`
t-device-is-only-the-upper-half-of-the-252061c5 = `{ $device }` 只是 `{ $mnemonic }` 的操作数的高位字

# did you mean `{name}`?
t-did-you-mean-name-69ddb50e = 是否应为 `{ $name }`？

# did you mean {names}?{compared}
t-did-you-mean-names-compared-6f869976 = 是否应为 { $names }？{ $compared }

# did you mean the label `{label}`?
t-did-you-mean-the-label-label-7bc33378 = 是否应为标号 `{ $label }`？

# e.g. {below}
t-e-g-below-f2c0f8ba = 例如 { $below }

# H0 to HFFFF here
t-h0-to-hffff-here-6371ecc0 = 此处为 H0 到 HFFFF

# H0 to HFFFFFFFF here
t-h0-to-hffffffff-here-6f23d388 = 此处为 H0 到 HFFFFFFFF

# {help}; 
t-help-c0998553 = { $help }；

# here only {ranges}
t-here-only-ranges-fb539eef = 此处只能使用 { $ranges }

# {in_words} here
t-in-words-here-67fe1c58 = 此处应为 { $in_words }

# `{index}` cannot be the index in the 32-bit instruction `{mnemonic}`
t-index-cannot-be-the-index-in-the-32-1ddbc0af = `{ $index }` 在 32 位指令 `{ $mnemonic }` 中不能用于变址

# `{index}` is not allowed here
t-index-is-not-allowed-here-55a23cec = 此处不允许使用 `{ $index }`

# inputs cannot be written
t-inputs-cannot-be-written-845651ff = 输入不能写入

# `INV` inverts the result of the contacts before it
t-inv-inverts-the-result-of-the-contacts-before-37b55de2 = `INV` 把之前触点的结果取反

# it has no {prefix}
t-it-has-no-prefix-e6fd9be9 = 没有 { $prefix }

# K-2147483648 to K2147483647 here
t-k-2147483648-to-k2147483647-here-fe3e05ce = 此处为 K-2147483648 到 K2147483647

# K-32768 to K32767 here
t-k-32768-to-k32767-here-6dff112c = 此处为 K-32768 到 K32767

# K{digits} is not a valid digit count for a {bits}-bit value
t-k-digits-is-not-a-valid-digit-count-346a4869 = K{ $digits } 不是 { $bits } 位数据的有效组数

# K{min} is not used
t-k-min-is-not-used-75bb1ec2 = 不使用 K{ $min }

# K{min} to K{max} are not used
t-k-min-to-k-max-are-not-used-6e28bdac = 不使用 K{ $min }～K{ $max }

# K{of}, K{twice}, … here
t-k-of-k-twice-here-765f2f46 = 此处为 K{ $of }、K{ $twice } 等

# K{whole} here
t-k-whole-here-1e7e2df5 = 此处应为 K{ $whole }

# K0 to K32767 here
t-k0-to-k32767-here-845e80a7 = 此处为 K0 到 K32767

# K1 to K{most} here
t-k1-to-k-most-here-6f0ab3cc = 此处应为 K1～K{ $most }

# `{kind}` cannot be operand {param} of `{mnemonic}`
t-kind-cannot-be-operand-param-of-mnemonic-d875a930 = `{ $kind }` 不能作为 `{ $mnemonic }` 的操作数 { $param }

# `{kind}` cannot be this operand of the 32-bit form
t-kind-cannot-be-this-operand-of-the-32-02f2d3c9 = `{ $kind }` 不能作为 32 位形式的此操作数

# `{kind}` contradicts the other operands
t-kind-contradicts-the-other-operands-583d509a = `{ $kind }` 与其他操作数矛盾

# `{kind}` does not fit in {bits} bits
t-kind-does-not-fit-in-bits-bits-7bcd38d5 = `{ $kind }` 超出 { $bits } 位的范围

# `{kind}` has no meaning here
t-kind-has-no-meaning-here-8b669cb9 = `{ $kind }` 在此处没有含义

# `{kind}` is a 16-bit counter; a 32-bit one is required here
t-kind-is-a-16-bit-counter-a-32-ff68bb07 = `{ $kind }` 是 16 位计数器；此处需要 32 位计数器

# `{kind}` is not a multiple of {of}
t-kind-is-not-a-multiple-of-of-d19b4a59 = `{ $kind }` 不是 { $of } 的倍数

# `{kind}` is not a value that is accepted here
t-kind-is-not-a-value-that-is-accepted-10456978 = `{ $kind }` 不是此处可用的值

# `{kind}` is outside the limits of operand {param}
t-kind-is-outside-the-limits-of-operand-param-40dc58d8 = `{ $kind }` 超出操作数 { $param } 的范围

# `{kind}` is too many groups of bits
t-kind-is-too-many-groups-of-bits-54cd1fd9 = 位元件组合的个数 `{ $kind }` 过多

# `{kind}` must have all {whole} digits here
t-kind-must-have-all-whole-digits-here-5c1966f2 = `{ $kind }` 在此处必须使用全部 { $whole } 组

# `{mnemonic}` does not exist: `{inst}` has no {missing} form
t-mnemonic-does-not-exist-inst-has-no-missing-9f4f3fc7 = `{ $mnemonic }` 不存在：`{ $inst }` 没有 { $missing }形式

# `{mnemonic}` is not available on {model}
t-mnemonic-is-not-available-on-model-6ee19bd3 = { $model } 不支持 `{ $mnemonic }`

# `{mnemonic}` needs {count}, found {found}
t-mnemonic-needs-count-found-found-2075d34b = `{ $mnemonic }` 需要 { $count }，实际为 { $found } 个

# `{mnemonic}` takes whole numbers
t-mnemonic-takes-whole-numbers-ac4fd9f4 = `{ $mnemonic }` 使用整数

# {model} holds {max_steps}
t-model-holds-max-steps-56bc01f0 = 机型 { $model } 最多 { $max_steps } 步

# move the register into a group of relays first: `MOV D0Z0 K4M0`
t-move-the-register-into-a-group-of-relays-518f3f9b = 先把寄存器传送到一组继电器：`MOV D0Z0 K4M0`

# {n} operands
t-n-operands-f71c4fcb = { $n } 个操作数

# `{name}` is an operand: write it on the line of its instruction
t-name-is-an-operand-write-it-on-the-489f09e1 = `{ $name }` 是操作数：写在其指令所在的行

# `{name}` takes 32 bits
t-name-takes-32-bits-0edf11c9 = `{ $name }` 使用 32 位

# `{name}` takes {counted}, found {operands}
t-name-takes-counted-found-operands-7826a808 = `{ $name }` 有 { $counted }，实际为 { $operands } 个

# `{name}` takes floats, here `{constant}`; a float takes two registers
t-name-takes-floats-here-constant-a-float-takes-a75ba9c3 = `{ $name }` 使用浮点数，此处为 `{ $constant }`；一个浮点数占两个寄存器

# `{name}` takes no operand
t-name-takes-no-operand-ccb541a0 = `{ $name }` 没有操作数

# name the device directly, or copy the indexed one first: `MOV`, `BMOV`
t-name-the-device-directly-or-copy-the-indexed-38726ea7 = 直接写软元件，或先复制变址的软元件：`MOV`、`BMOV`

# name the first and the last device of one class
t-name-the-first-and-the-last-device-of-9efe8c0c = 首软元件和末软元件须为同一类型

# name the pointer directly: one `{mnemonic}` for each, under a comparison of the index register
t-name-the-pointer-directly-one-mnemonic-for-each-6431c2c1 = 直接写出指针：每个指针各用一条 `{ $mnemonic }`，由变址寄存器的比较触点驱动

# no {missing} form
t-no-missing-form-265b21a6 = 没有 { $missing }形式

# no model has this instruction
t-no-model-has-this-instruction-155e78e9 = 所有机型都没有此指令

# no such buffer memory
t-no-such-buffer-memory-472adc88 = 没有此缓冲存储区（BFM）

# no supported model has it
t-no-supported-model-has-it-a9aa8efe = 支持的机型都没有它

# not accepted here
t-not-accepted-here-2f697253 = 此处不接受

# not on {model}
t-not-on-model-01c4f80e = { $model } 没有

# `{one}` does not match `{another}`
t-one-does-not-match-another-521cbb4f = `{ $one }` 与 `{ $another }` 不匹配

# `{one}` must be in the same range as, and not before, `{another}`
t-one-must-be-in-the-same-range-as-bd5545d4 = `{ $one }` 必须与 `{ $another }` 在同一范围内，并且不在其之前

# `{one}` must be of the same class as `{another}`
t-one-must-be-of-the-same-class-as-b54d9b00 = `{ $one }` 必须与 `{ $another }` 是同一种软元件

# `{one}` must be smaller than `{another}`
t-one-must-be-smaller-than-another-5f148f13 = `{ $one }` 必须小于 `{ $another }`

# `{one}` must have as many digits as `{another}`
t-one-must-have-as-many-digits-as-another-c9d0f22c = `{ $one }` 的位数必须与 `{ $another }` 相同

# `{one}` must not be greater than `{another}`
t-one-must-not-be-greater-than-another-03af2964 = `{ $one }` 不得大于 `{ $another }`

# `{one}` must not be smaller than `{another}`
t-one-must-not-be-smaller-than-another-2eca5082 = `{ $one }` 不得小于 `{ $another }`

# only a data register has bits: `D0.F`
t-only-a-data-register-has-bits-d0-f-11547a75 = 只有数据寄存器可以指定位：`D0.F`

# only the 16-bit form takes it
t-only-the-16-bit-form-takes-it-3e99cd52 = 只有 16 位形式可以使用它

# only these outputs of {model} keep a position: {ranges}
t-only-these-outputs-of-model-keep-a-position-37336c6b = { $model } 只有这些输出保存位置：{ $ranges }

# only these outputs of {model} send pulses: {ranges}
t-only-these-outputs-of-model-send-pulses-ranges-c8f0d312 = { $model } 只有这些输出可以输出脉冲：{ $ranges }

# operand {names} is missing
t-operand-names-is-missing-8948255c = 缺少操作数 { $names }

# operand {param} of `{mnemonic}` cannot take an index register{with} on {model}
t-operand-param-of-mnemonic-cannot-take-an-index-f01e304e = `{ $mnemonic }` 的操作数 { $param }{ $with } 在 { $model } 上不能使用变址寄存器

# operand {param} of `{mnemonic}` uses {count} devices starting at `{device}`, but `{end}` is the last one
t-operand-param-of-mnemonic-uses-count-devices-starting-8e76b76a = `{ $mnemonic }` 的操作数 { $param } 从 `{ $device }` 开始占用 { $count } 个软元件，但最后一个是 `{ $end }`

# operands {names} are missing
t-operands-names-are-missing-7c499043 = 缺少操作数 { $names }

# pulse
t-pulse-550bfe9e = 脉冲执行

# put each on its own line
t-put-each-on-its-own-line-317cebb0 = 各放到单独一行

# put it on its own line
t-put-it-on-its-own-line-80974120 = 放到单独一行

# scale the value, and write a whole number such as `K15`
t-scale-the-value-and-write-a-whole-number-a4cbe464 = 换算数值，改用整数，如 `K15`

# start at `{first}` or below
t-start-at-first-or-below-10602d2c = 从 `{ $first }` 或更小的编号开始

# starts here
t-starts-here-66ea5c3a = 从这里开始

# step {expected}, counting the instructions before it
t-step-expected-counting-the-instructions-before-it-38c387d8 = 按前面的指令计算，为第 { $expected } 步

# `{text}` is not a valid operand
t-text-is-not-a-valid-operand-5fabbc37 = `{ $text }` 不是有效的操作数

# the coil is `OUT` here
t-the-coil-is-out-here-eb2932a5 = 此处线圈是 `OUT`

# the coil that is on for one scan is `PLS`, the contact `LDP`
t-the-coil-that-is-on-for-one-scan-51f60f1d = 接通一个扫描周期的线圈是 `PLS`，触点是 `LDP`

# the coil that is on for one scan is `PLF`, the contact `LDF`
t-the-coil-that-is-on-for-one-scan-8e08a558 = 接通一个扫描周期的线圈是 `PLF`，触点是 `LDF`

# the comparison is `{right}`
t-the-comparison-is-right-b28f05c7 = 此比较写作 `{ $right }`

# the first contact of a rung is `LD` here
t-the-first-contact-of-a-rung-is-ld-b21908c0 = 此处梯级的第一个触点是 `LD`

# the index is a pair here, named by its Z
t-the-index-is-a-pair-here-named-by-a2a6c16f = 此处变址寄存器是一对，用其中的 Z 表示

# the memory capacity in the PLC parameters leaves {steps}
t-the-memory-capacity-in-the-plc-parameters-leaves-c101ac21 = 按 PLC 参数的存储器容量只有 { $steps } 步

# the negated contact is `ANI` here
t-the-negated-contact-is-ani-here-ed9420b2 = 此处取反触点是 `ANI`

# the negated contact is `LDI` here
t-the-negated-contact-is-ldi-here-a829a897 = 此处取反触点是 `LDI`

# the negated contact is `ORI` here
t-the-negated-contact-is-ori-here-b0ad2a74 = 此处取反触点是 `ORI`

# the number of `{device}` does not end in 0
t-the-number-of-device-does-not-end-in-81e25c40 = `{ $device }` 的编号末位不是 0

# the number of `{device}` is not a multiple of {of}
t-the-number-of-device-is-not-a-multiple-38e5ce9a = `{ $device }` 的编号不是 { $of } 的倍数

# the program has {counted} steps, but {room}
t-the-program-has-counted-steps-but-room-efa76c37 = 程序有 { $counted } 步，但{ $room }

# the program may be for another model (`--model`), or a line may be missing before this one
t-the-program-may-be-for-another-model-model-a17654a8 = 程序可能用于其他机型（`--model`），或此行之前可能缺少一行

# the project states {stated} steps for `{mnemonic}`, which has {length} with these operands on {model}
t-the-project-states-stated-steps-for-mnemonic-which-9de16b3e = 工程中注明 `{ $mnemonic }` 为 { $stated } 步，但使用这些操作数时，它在 { $model } 上为 { $length } 步

# the source numbers this step {stated}, but on {model} it is step {expected}{more}
t-the-source-numbers-this-step-stated-but-on-136dea25 = 源文件中此步的步号为 { $stated }，但在 { $model } 上是第 { $expected } 步{ $more }

# there is no negated coil: write `INV` before `OUT`
t-there-is-no-negated-coil-write-inv-before-06dd587c = 没有取反线圈：在 `OUT` 之前写 `INV`

# this …
t-this-8fafe08d = 此处...

# this may be another instruction
t-this-may-be-another-instruction-ce7e5842 = 这可能是另一条指令

# too many operands from here on
t-too-many-operands-from-here-on-75fbc06d = 从此处起操作数过多

# `U{module}\G{address}` does not exist (modules U0–U{LAST_MODULE}, addresses G0–G{LAST_ADDRESS})
t-u-module-g-address-does-not-exist-modules-1c272ba2 = `U{ $module }\G{ $address }` 不存在（模块 U0～U{ $LAST_MODULE }，地址 G0～G{ $LAST_ADDRESS }）

# unknown instruction `{mnemonic}`
t-unknown-instruction-mnemonic-f6eaff5b = 未知的指令 `{ $mnemonic }`

# up to `{last}`
t-up-to-last-583396a7 = 到 `{ $last }` 为止

# use a pair of data registers, and move its low word to the index register
t-use-a-pair-of-data-registers-and-move-856e4bbd = 使用一对数据寄存器，再把其低位字传送到变址寄存器

# use the 32-bit form `{name}`
t-use-the-32-bit-form-name-3935cba7 = 使用 32 位形式 `{ $name }`

# use `Z{number}` and clear `{index}`
t-use-z-number-and-clear-index-1c4d3841 = 使用 `Z{ $number }`，并把 `{ $index }` 清零

# use `Z{number}`
t-use-z-number-dac70437 = 使用 `Z{ $number }`

# V and Z are a pair here, named by its Z
t-v-and-z-are-a-pair-here-named-ed0083af = 此处 V 和 Z 是一对，用其中的 Z 表示

# write `AND`
t-write-and-688c0967 = 写成 `AND`

# write each instruction on its own line
t-write-each-instruction-on-its-own-line-11428282 = 每条指令各占一行

# write `{form}`
t-write-form-7754e66a = 写作 `{ $form }`

# write {forms}
t-write-forms-edcc7d3b = 写成 { $forms }

# write `{group}`
t-write-group-2d180db9 = 改为 `{ $group }`

# write `{name}`
t-write-name-07c6f7b3 = 改为 `{ $name }`

# write `{name}` and `{constant}`
t-write-name-and-constant-d925dfa2 = 改为 `{ $name }` 和 `{ $constant }`

# write `{only}`
t-write-only-9c2c1dfa = 改为 `{ $only }`

# write `OR`
t-write-or-156e49f3 = 写成 `OR`

# write `RST`
t-write-rst-799f7327 = 写成 `RST`

# write `{second}` on its own line
t-write-second-on-its-own-line-1cd78977 = 把 `{ $second }` 单独写成一行

# write `SET`
t-write-set-a014fd7c = 写成 `SET`

# write `{text}`
t-write-text-8ccd2e5b = 改为 `{ $text }`

# write `Z{number}`
t-write-z-number-c7aed84f = 改为 `Z{ $number }`
