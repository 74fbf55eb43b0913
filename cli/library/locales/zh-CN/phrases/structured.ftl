# CASE lists this value twice
t-case-lists-this-value-twice-f5803681 = CASE 重复列出此值

# CASE takes a whole number, and this is {ty}
t-case-takes-a-whole-number-and-this-is-6663abbc = CASE 需要整数，而这里是{ $ty }

# EXIT stands in no loop
t-exit-stands-in-no-loop-bb7d9da2 = EXIT 不在循环中

# FOR counts an INT or DINT, and this is {ty}
t-for-counts-an-int-or-dint-and-this-1e7c620a = FOR 用 INT 或 DINT 计数，而这里是{ $ty }

# FX has no type {name}
t-fx-has-no-type-name-2c2e5ae7 = FX 没有类型 { $name }

# GX Works2 compiles no initial values for FX
t-gx-works2-compiles-no-initial-values-for-fx-f34017b6 = GX Works2 不为 FX 编译初始值

# NOT takes a BOOL, and this is {ty}
t-not-takes-a-bool-and-this-is-ty-2b783fa1 = NOT 需要 BOOL，而这里是{ $ty }

# `**` is not compiled yet
t-is-not-compiled-yet-1b9e559b = `**` 尚不能编译

# `;` is missing here
t-is-missing-here-3eb51052 = 此处缺少 `;`

# `{block}` has fewer inputs
t-block-has-fewer-inputs-64635856 = `{ $block }` 的输入没有这么多

# `{block}` has no `{member}`
t-block-has-no-member-3164ae43 = `{ $block }` 没有 `{ $member }`

# `{block}` has no input or output `{name}`
t-block-has-no-input-or-output-name-062cdf8c = `{ $block }` 没有输入或输出 `{ $name }`

# `{keyword}` has no meaning in a program
t-keyword-has-no-meaning-in-a-program-1ef41ad2 = `{ $keyword }` 在程序中没有意义

# `{keyword}` is missing
t-keyword-is-missing-74e22caa = 缺少 `{ $keyword }`

# `{member}` is not a bit of {of}
t-member-is-not-a-bit-of-of-5cf7782c = `{ $member }` 不是{ $of }的位

# `{name}` has no member `{member}`
t-name-has-no-member-member-0f87241d = `{ $name }` 没有成员 `{ $member }`

# `{name}` has no members
t-name-has-no-members-7d015dae = `{ $name }` 没有成员

# `{name}` is a keyword, which cannot be a name
t-name-is-a-keyword-which-cannot-be-a-f1b616ff = `{ $name }` 是关键字，不能作名称

# `{name}` is a label, which cannot be called
t-name-is-a-label-which-cannot-be-called-94a295ad = `{ $name }` 是标签，不能调用

# `{name}` is an array of function blocks
t-name-is-an-array-of-function-blocks-61c643ef = `{ $name }` 是功能块的数组

# `{name}` is an instance of a function block
t-name-is-an-instance-of-a-function-block-be26bc37 = `{ $name }` 是功能块的实例

# `{name}` is declared twice
t-name-is-declared-twice-59f35700 = `{ $name }` 声明了两次

# `{name}` is given twice
t-name-is-given-twice-d68d019f = `{ $name }` 给出了两次

# `{name}` is the name of a type
t-name-is-the-name-of-a-type-9f7abef6 = `{ $name }` 是类型的名称

# `{name}` is the name of {what}
t-name-is-the-name-of-what-dea71ba1 = `{ $name }` 是{ $what }的名称

# `{name}` is written, so it has to be a label or device
t-name-is-written-so-it-has-to-be-a958a28a = `{ $name }` 会被写入，因此必须是标签或软元件

# `{name}` of `{block}` is not given
t-name-of-block-is-not-given-31b5dc74 = 没有给出 `{ $block }` 的 `{ $name }`

# `{name}` takes EN alone, which is TRUE
t-name-takes-en-alone-which-is-true-facbecef = `{ $name }` 只需要 EN，其值为 TRUE

# `{name}` takes EN and its operands
t-name-takes-en-and-its-operands-c56c1428 = `{ $name }` 需要 EN 和操作数

# `{name}` takes EN, a device and a value
t-name-takes-en-a-device-and-a-value-1ff6de2d = `{ $name }` 需要 EN、软元件和值

# `{name}` takes a label of its type
t-name-takes-a-label-of-its-type-f1d4a936 = `{ $name }` 需要同类型的标签

# `{name}` takes no element with a variable index
t-name-takes-no-element-with-a-variable-index-14a7ab7c = `{ $name }` 不能是带变量下标的元素

# `{name}` takes one argument, and {given} are given
t-name-takes-one-argument-and-given-are-given-2d89cd68 = `{ $name }` 需要一个参数，而给出了 { $given } 个

# `{name}` takes {count} operands after EN, not {given}
t-name-takes-count-operands-after-en-not-given-9ed21582 = `{ $name }` 在 EN 之后需要 { $count } 个操作数，而不是 { $given } 个

# `{name}` takes {from}, and this is {ty}
t-name-takes-from-and-this-is-ty-037ed47c = `{ $name }` 需要{ $from }，而这里是{ $ty }

# `{operand}` cannot hold {ty}
t-operand-cannot-hold-ty-e1808229 = `{ $operand }` 放不下{ $ty }

# `{operand}` is an input, which the PLC reads
t-operand-is-an-input-which-the-plc-reads-9ca8dcf3 = `{ $operand }` 是由 PLC 读取的输入

# `{sign}` does not take texts
t-sign-does-not-take-texts-adf1c3db = `{ $sign }` 不能用于字符串

# `{sign}` joins {a} and {b}
t-sign-joins-a-and-b-56f248bf = `{ $sign }` 连接了{ $a }和{ $b }

# `{sign}` of DWORD values is not compiled yet
t-sign-of-dword-values-is-not-compiled-yet-d221de6b = 尚不能编译 DWORD 值的 `{ $sign }`

# `{text}` has no meaning in structured text
t-text-has-no-meaning-in-structured-text-e0ea7d4f = `{ $text }` 在结构化文本中没有意义

# `{text}` is not a value
t-text-is-not-a-value-f1ad16e5 = `{ $text }` 不是值

# `{text}` is not an address
t-text-is-not-an-address-72a56492 = `{ $text }` 不是地址

# `{token}` cannot follow here
t-token-cannot-follow-here-5f28f4a2 = 此处不能出现 `{ $token }`

# a STRING({length})
t-a-string-length-900ba912 = STRING({ $length })

# a bit or contact with a variable index is compiled for BOOL alone
t-a-bit-or-contact-with-a-variable-index-5e3e2254 = 带变量下标的位或触点只能是 BOOL

# a bit with a variable index cannot stand in an instruction
t-a-bit-with-a-variable-index-cannot-stand-ceccb403 = 指令中不能使用带变量下标的位

# a call gives this in its place
t-a-call-gives-this-in-its-place-17404ad0 = 调用时由此处代替它

# a condition cannot stand here
t-a-condition-cannot-stand-here-e0427756 = 此处不能是条件

# a constant or a group of bits is not converted to 16 bits
t-a-constant-or-a-group-of-bits-is-ee0cc6c7 = 常数或位组不能转换为 16 位

# a counter of 32 bits
t-a-counter-of-32-bits-4f61ae22 = 32 位计数器

# a counter of FOR with a variable index is not compiled yet
t-a-counter-of-for-with-a-variable-index-0ae18215 = 尚不能编译带变量下标的 FOR 计数变量

# a declaration ends in `;`
t-a-declaration-ends-in-b829228a = 声明以 `;` 结束

# a device
t-a-device-7c776f4e = 软元件

# a device or constant
t-a-device-or-constant-fad4e2d5 = 软元件或常数

# a function block gets its devices by itself
t-a-function-block-gets-its-devices-by-itself-31122dc3 = 功能块的软元件自动分配

# a group of 32 bits
t-a-group-of-32-bits-d9a04a1f = 32 位的位组

# a label of CASE is a constant whole number
t-a-label-of-case-is-a-constant-whole-23d1595c = CASE 的分支值是整数常数

# a member is at a device that is not part of another
t-a-member-is-at-a-device-that-is-00bbe3c5 = 成员的软元件不能是另一个软元件的一部分

# a member of a structure states no device
t-a-member-of-a-structure-states-no-device-f952e072 = 结构体的成员不指定软元件

# a name
t-a-name-8776731f = 名称

# a number with a fraction
t-a-number-with-a-fraction-73304cbe = 小数

# a program declares its labels in `VAR` … `END_VAR`
t-a-program-declares-its-labels-in-var-end-a1a1f649 = 程序在 `VAR` 与 `END_VAR` 之间声明标签

# a register of 16 bits
t-a-register-of-16-bits-246ac207 = 16 位寄存器

# a register of 16 bits has the bits 0 to F
t-a-register-of-16-bits-has-the-bits-637b84e7 = 16 位寄存器的位为 0～F

# a statement
t-a-statement-13fd7341 = 语句

# a statement ends in `;`
t-a-statement-ends-in-57b39b9b = 语句以 `;` 结束

# a structure `{name}`
t-a-structure-name-ef87ea40 = 结构体 `{ $name }`

# a structure gets its devices by itself
t-a-structure-gets-its-devices-by-itself-1d1be317 = 结构体的软元件自动分配

# a structure with a TIMER or COUNTER is not compiled yet
t-a-structure-with-a-timer-or-counter-is-eed9e4e0 = 尚不能编译含有 TIMER 或 COUNTER 的结构体

# a task has no setting `{key}`
t-a-task-has-no-setting-key-72b2e2b9 = 任务没有设置 `{ $key }`

# a text of an instruction has at most {most} characters
t-a-text-of-an-instruction-has-at-most-d3910778 = 指令中的字符串最多 { $most } 个字符

# a timer or counter
t-a-timer-or-counter-1b2b6a62 = 定时器或计数器

# a type
t-a-type-7bb6c3ec = 类型

# a value is assigned to {to}
t-a-value-is-assigned-to-to-ed5dd491 = 把一个值赋给了{ $to }

# a variable index is computed in Z0 here
t-a-variable-index-is-computed-in-z0-here-b3245f16 = 此处用 Z0 计算变量下标

# a variable index takes 16 bits: begin the array at a lower device
t-a-variable-index-takes-16-bits-begin-the-7f4f9e01 = 变量下标为 16 位：让数组从编号更小的软元件开始

# a whole array
t-a-whole-array-d450b5b6 = 整个数组

# a whole number
t-a-whole-number-4eb411b0 = 整数

# add its file, or leave out the line
t-add-its-file-or-leave-out-the-line-3cac3675 = 加入它的文件，或去掉这一行

# again here
t-again-here-a6466ab3 = 在此处重复声明

# an INT
t-an-int-b5c58acb = INT

# an array cannot begin at `{operand}`
t-an-array-cannot-begin-at-operand-b35e22c7 = 数组不能从 `{ $operand }` 开始

# an expression
t-an-expression-37757d60 = 表达式

# an index is a whole number
t-an-index-is-a-whole-number-5b44e85f = 下标是整数

# an index is a whole number, and this is {ty}
t-an-index-is-a-whole-number-and-this-f0dd2e85 = 下标是整数，而这里是{ $ty }

# an input that is an array or structure is not compiled yet
t-an-input-that-is-an-array-or-structure-cc560235 = 尚不能编译数组或结构体类型的输入

# an instruction or function
t-an-instruction-or-function-5f7c2be9 = 指令或函数

# an instruction takes one element with a variable index
t-an-instruction-takes-one-element-with-a-variable-5eadfec3 = 一条指令只能有一个带变量下标的元素

# an interval is a multiple of 10 ms, up to 327.67 s
t-an-interval-is-a-multiple-of-10-ms-bcaca904 = 周期是 10 ms 的倍数，最长 327.67 s

# an operator
t-an-operator-a3c93862 = 运算符

# an output is a label or device without a variable index
t-an-output-is-a-label-or-device-without-7cddc8b6 = 输出是不带变量下标的标签或软元件

# an output that is an array or structure is not compiled yet
t-an-output-that-is-an-array-or-structure-e05b9968 = 尚不能编译数组或结构体类型的输出

# an output to an element with a variable index is not compiled yet
t-an-output-to-an-element-with-a-variable-2d2ca398 = 尚不能编译写到带变量下标元素的输出

# another one
t-another-one-b260b980 = 另一个

# arguments of a function block have names
t-arguments-of-a-function-block-have-names-dbcb0a16 = 功能块的参数要写名称

# arguments of functions of the library have no names
t-arguments-of-functions-of-the-library-have-no-9fbd9ec3 = 库函数的参数不写名称

# arguments of instructions have no names
t-arguments-of-instructions-have-no-names-7ef875d4 = 指令的参数不写名称

# arrays and structures that are constant are not compiled yet
t-arrays-and-structures-that-are-constant-are-not-1fbeda4b = 尚不能编译常数的数组和结构体

# assign it in the first scan: `IF M8002 THEN … END_IF;`
t-assign-it-in-the-first-scan-if-m8002-a613e4a1 = 在第一个扫描中赋值：`IF M8002 THEN … END_IF;`

# assign it to a label first
t-assign-it-to-a-label-first-4185765d = 先把它赋给标签

# assign it to a label, or the label to it
t-assign-it-to-a-label-or-the-label-9aeb2495 = 把它赋给标签，或把标签赋给它

# assign one of them to a label
t-assign-one-of-them-to-a-label-4692aa03 = 把其中一个赋给标签

# assign parts to labels, or split the statement
t-assign-parts-to-labels-or-split-the-statement-e31550b1 = 把各部分赋给标签，或拆分语句

# assign something to it, `NAME := VALUE;`, or call it, `NAME(…);`
t-assign-something-to-it-name-value-or-call-444c9a61 = 给它赋值，`NAME := VALUE;`，或调用它，`NAME(…);`

# assign the value to a label of your own that several statements share
t-assign-the-value-to-a-label-of-your-4dc1abb0 = 把值赋给自己声明的标签，供多条语句共用

# call `OUT_T(EN, TC0, 50)`, `OUT_C(EN, CC0, 50)` or `RST(EN, TC0)`
t-call-out-t-en-tc0-50-out-c-b6e759ca = 调用 `OUT_T(EN, TC0, 50)`、`OUT_C(EN, CC0, 50)` 或 `RST(EN, TC0)`

# call it: `{name}(…);`
t-call-it-name-4f07ebcf = 调用它：`{ $name }(…);`

# choose another name
t-choose-another-name-98325a82 = 换一个名称

# choose another name for the label
t-choose-another-name-for-the-label-09340acc = 给标签换一个名称

# compare it with something, such as `<> 0`
t-compare-it-with-something-such-as-0-1a127a76 = 把它与其他值比较，如 `<> 0`

# convert one side: `{function}(…)`
t-convert-one-side-function-5c66dcae = 转换其中一边：`{ $function }(…)`

# convert to DINT, which has a sign: `DWORD_TO_DINT(…)`
t-convert-to-dint-which-has-a-sign-dword-0fd82dfa = 转换为带符号的 DINT：`DWORD_TO_DINT(…)`

# copy it to a label, and back after the call
t-copy-it-to-a-label-and-back-after-9ae2d99a = 先复制到一个标签，调用之后再复制回来

# copy them with `BMOV(EN, From[0], Count, To[0])`
t-copy-them-with-bmov-en-from-0-count-e8f17274 = 用 `BMOV(EN, From[0], Count, To[0])` 复制

# cut it: `LEFT(…, {most})`
t-cut-it-left-most-8f89612b = 截断它：`LEFT(…, { $most })`

# declare it in `VAR` … `END_VAR`, or write a device such as `M0`
t-declare-it-in-var-end-var-or-write-a3c1af10 = 在 `VAR` 与 `END_VAR` 之间声明它，或写出软元件，如 `M0`

# declared here
t-declared-here-4480adaf = 在此处声明

# define it here, in a file of the same folder, or in one that `[project] program` in rungc.toml lists
t-define-it-here-in-a-file-of-the-c9a494b8 = 在此处、同一文件夹的文件中，或 rungc.toml 的 `[project] program` 列出的文件中定义它

# divide it: `T#5s / T#100ms`
t-divide-it-t-5s-t-100ms-c9e01ccf = 用除法换算：`T#5s / T#100ms`

# expected at the latest here
t-expected-at-the-latest-here-76589ac6 = 最迟应在此处出现

# expected {wanted}
t-expected-wanted-b63dc96e = 此处应为{ $wanted }

# fewer than 15 devices {prefix} follow this array of bits
t-fewer-than-15-devices-prefix-follow-this-array-b413ce13 = 此位数组之后的软元件 { $prefix } 不足 15 个

# first here
t-first-here-63749d4d = 先在此处声明

# give it in each call, and name what the call gives
t-give-it-in-each-call-and-name-what-4cd8acf6 = 每次调用都给出它，并直接写出调用时所给的内容

# it has INTERVAL, PRIORITY and SINGLE
t-it-has-interval-priority-and-single-721e0c80 = 它有 INTERVAL、PRIORITY 和 SINGLE

# it holds ASCII; others are written by their number: `$E9`, and `$$` is one `$`
t-it-holds-ascii-others-are-written-by-their-f5ac74ff = 它存放 ASCII 字符；其他字符用编号书写：`$E9`，而 `$$` 表示一个 `$`

# it holds {least} to {most}
t-it-holds-least-to-most-59cde7bd = 它的范围是 { $least } 至 { $most }

# join several: `CONCAT('…', '…')`
t-join-several-concat-fd06969a = 把几个连接起来：`CONCAT('…', '…')`

# leave out INTERVAL, and use TON in the program
t-leave-out-interval-and-use-ton-in-the-0fb71728 = 去掉 INTERVAL，在程序中使用 TON

# leave out `AT`
t-leave-out-at-112783e3 = 去掉 `AT`

# more than {most} members and elements are not copied at once
t-more-than-most-members-and-elements-are-not-9ed0a7fe = 一次不能复制超过 { $most } 个成员和元素

# name a member or element; only `:=` copies all of them
t-name-a-member-or-element-only-copies-all-05461789 = 写出一个成员或元素；只有 `:=` 能复制全部

# name one of them by a constant index within the bounds
t-name-one-of-them-by-a-constant-index-9cead044 = 用范围之内的常数下标指定其中一个

# never run
t-never-run-21576b6c = 从不执行

# no device {prefix} is left for `{name}`
t-no-device-prefix-is-left-for-name-9f44b751 = 没有剩余的软元件 { $prefix } 可用于 `{ $name }`

# no device {prefix} is left for a value in between
t-no-device-prefix-is-left-for-a-value-80e771df = 没有剩余的软元件 { $prefix } 可用于中间值

# no pointer P is left for IF, CASE, loops and subroutines
t-no-pointer-p-is-left-for-if-case-3f0e4bf5 = 没有剩余的指针 P 可用于 IF、CASE、循环和子程序

# no task runs `{name}`
t-no-task-runs-name-d73fddb2 = 没有任务运行 `{ $name }`

# no task runs a program
t-no-task-runs-a-program-4c6e6e68 = 没有任务运行程序

# no timer of 10 ms is left for this task
t-no-timer-of-10-ms-is-left-for-c70bf9cc = 没有剩余的 10 ms 定时器可用于此任务

# nothing calls `{name}`
t-nothing-calls-name-20f17fee = 没有地方调用 `{ $name }`

# nothing declares `{name}`
t-nothing-declares-name-1f30ca28 = 没有声明 `{ $name }`

# nothing defines `{name}`, which is called here
t-nothing-defines-name-which-is-called-here-9251ae2f = 没有定义此处调用的 `{ $name }`

# nothing defines the function `{name}`
t-nothing-defines-the-function-name-9a2b466e = 没有定义函数 `{ $name }`

# nothing defines the type `{name}`
t-nothing-defines-the-type-name-1bb63036 = 没有定义类型 `{ $name }`

# nothing uses `{name}`
t-nothing-uses-name-dfc88c79 = 没有地方使用 `{ $name }`

# run the program in each scan, with `IF` around its statements
t-run-the-program-in-each-scan-with-if-6e666898 = 在每次扫描中执行此程序，并把语句放在 `IF` 之内

# state a device with `AT`, or shorten the arrays
t-state-a-device-with-at-or-shorten-the-600ebae1 = 用 `AT` 指定软元件，或缩短数组

# structures nest deeper than {most} levels
t-structures-nest-deeper-than-most-levels-20a5c06f = 结构体的嵌套超过 { $most } 层

# subroutines call each other in {most} levels at most
t-subroutines-call-each-other-in-most-levels-at-6d0f56e6 = 子程序的调用最多 { $most } 层

# tasks that a bit or an interrupt starts are not compiled yet
t-tasks-that-a-bit-or-an-interrupt-starts-1cfc313e = 尚不能编译由位或中断启动的任务

# texts are compared by `=` and `<>`, and joined by `CONCAT(a, b)`
t-texts-are-compared-by-and-and-joined-by-f8247c24 = 字符串用 `=` 和 `<>` 比较，用 `CONCAT(a, b)` 连接

# the PLC has no such floating-point number
t-the-plc-has-no-such-floating-point-number-a15be835 = PLC 没有这样的浮点数

# the array has the elements {first} to {last}
t-the-array-has-the-elements-first-to-last-e40f4c90 = 数组的元素为 { $first } 至 { $last }

# the constant 0
t-the-constant-0-550fe730 = 常数 0

# the constant `{name}` has no value
t-the-constant-name-has-no-value-f073aabb = 常数 `{ $name }` 没有值

# the contact of `{device}` is not assigned to
t-the-contact-of-device-is-not-assigned-to-f40523eb = 不能给 `{ $device }` 的触点赋值

# the function `{name}` has no result
t-the-function-name-has-no-result-8e90dfcf = 函数 `{ $name }` 没有结果

# the instance of `{block}` does not hold `{name}`
t-the-instance-of-block-does-not-hold-name-70302561 = `{ $block }` 的实例不保存 `{ $name }`

# the length of a STRING is 1 to {most}
t-the-length-of-a-string-is-1-to-fb99f1e4 = STRING 的长度为 1 至 { $most }

# the name of a member or the number of a bit
t-the-name-of-a-member-or-the-number-66f6f8b5 = 成员的名称或位的编号

# the number of places is a constant from 0 to {most}
t-the-number-of-places-is-a-constant-from-625bc7f3 = 位数是 0 至 { $most } 的常数

# the program calls blocks more than {most} times
t-the-program-calls-blocks-more-than-most-times-40a6395c = 程序调用功能块超过 { $most } 次

# the programs that run
t-the-programs-that-run-f3803117 = 要执行的程序

# the range is that of GX Works2 for this model; join conditions, or split the program
t-the-range-is-that-of-gx-works2-for-c6808701 = 此范围由 GX Works2 为此机型规定；合并条件，或拆分程序

# the result of `{name}` is not a value
t-the-result-of-name-is-not-a-value-0e070138 = `{ $name }` 的结果不是值

# the step of FOR is a constant other than 0
t-the-step-of-for-is-a-constant-other-1b4519ee = FOR 的步长是 0 以外的常数

# the structure `{name}` contains itself
t-the-structure-name-contains-itself-8914bd80 = 结构体 `{ $name }` 包含自身

# the structure `{name}` has no members
t-the-structure-name-has-no-members-d5864c80 = 结构体 `{ $name }` 没有成员

# the text ends here
t-the-text-ends-here-98e2b93b = 文本在此处结束

# the value of a timer counts its steps, and this is a TIME
t-the-value-of-a-timer-counts-its-steps-b7077d52 = 定时器的值按其单位计数，而这里是 TIME

# there are too many instances of blocks, or of blocks in blocks, at `{name}`
t-there-are-too-many-instances-of-blocks-or-8dd20f5a = 在 `{ $name }` 处，功能块或功能块中的功能块的实例过多

# there is no program `{program}` in structured text
t-there-is-no-program-program-in-structured-text-6d0e3871 = 没有结构化文本的程序 `{ $program }`

# there is no task `{task}`
t-there-is-no-task-task-469c0aec = 没有任务 `{ $task }`

# these are not the bounds of an array
t-these-are-not-the-bounds-of-an-array-4f387c4c = 此处不是数组的上下界

# these quotation marks are not closed on the line
t-these-quotation-marks-are-not-closed-on-the-bd71a5ed = 引号在本行中没有结束

# this alone is not a statement
t-this-alone-is-not-a-statement-ac4aef19 = 仅此不构成语句

# this calls itself, or nests more calls than the PLC can
t-this-calls-itself-or-nests-more-calls-than-00a81262 = 它调用自身，或调用的嵌套超过 PLC 的限制

# this cannot be called
t-this-cannot-be-called-db586f42 = 此处的内容不能调用

# this comment is not closed
t-this-comment-is-not-closed-d0b8197b = 注释没有结束

# this condition is not compiled yet
t-this-condition-is-not-compiled-yet-b50b3772 = 此条件尚不能编译

# this divides by 0
t-this-divides-by-0-8162ebc0 = 此处除以 0

# this function does not take {given} arguments
t-this-function-does-not-take-given-arguments-56d22531 = 此函数不能有 { $given } 个参数

# this function is not compiled for {ty}
t-this-function-is-not-compiled-for-ty-b7574435 = 此函数不能用于{ $ty }

# this has no members
t-this-has-no-members-37c700c3 = 此处没有成员

# this index register does not keep its value
t-this-index-register-does-not-keep-its-value-bacc2cec = 此变址寄存器不保持其值

# this is never run
t-this-is-never-run-2ba6752c = 此语句从不执行

# this is never true
t-this-is-never-true-8e6a6af7 = 此条件永不成立

# this is not a constant
t-this-is-not-a-constant-beb9deb3 = 这不是常数

# this is not a device
t-this-is-not-a-device-3080ce7d = 此处不是软元件

# this is not an array
t-this-is-not-an-array-9a536870 = 此处不是数组

# this is not closed
t-this-is-not-closed-9a8908aa = 此处没有对应的结束

# this is not compiled yet
t-this-is-not-compiled-yet-8274618f = 此处尚不能编译

# this is the second CONFIGURATION
t-this-is-the-second-configuration-795a8692 = 这是第二个 CONFIGURATION

# this is {given}
t-this-is-given-6848cffe = 这是{ $given }

# this is {given}, and the output is {ty}
t-this-is-given-and-the-output-is-ty-fc3e15c0 = 这里是{ $given }，而输出是{ $ty }

# this is {given}, not an array
t-this-is-given-not-an-array-9a71197b = 这是{ $given }，不是数组

# this is {given}, where {expected} is expected
t-this-is-given-where-expected-is-expected-5a55b5ff = 这里是{ $given }，而应为{ $expected }

# this is {ty}, and the value before it {before}
t-this-is-ty-and-the-value-before-it-bb54e1ec = 这里是{ $ty }，而它前面的值是{ $before }

# this is {ty}, where a STRING is expected
t-this-is-ty-where-a-string-is-expected-bb60eb31 = 这里是{ $ty }，而应为 STRING

# this leaves before it
t-this-leaves-before-it-452c40df = 此处先行离开

# this nests deeper than {most} levels
t-this-nests-deeper-than-most-levels-db0310ee = 嵌套超过 { $most } 层

# this range is empty: its end is below its beginning
t-this-range-is-empty-its-end-is-below-189037e6 = 此范围为空：终点小于起点

# this statement has more than {most} words and signs
t-this-statement-has-more-than-most-words-and-c56535f7 = 此语句超过 { $most } 个单词和符号

# this takes the instruction `{name}`, which {model} does not have
t-this-takes-the-instruction-name-which-model-does-0b4c36c9 = 这需要指令 `{ $name }`，而 { $model } 没有它

# this text has a character that STRING does not hold
t-this-text-has-a-character-that-string-does-b1063737 = 此字符串含有 STRING 不能存放的字符

# this text has more than {most} characters
t-this-text-has-more-than-most-characters-dfac4ddb = 此字符串超过 { $most } 个字符

# this text holds no PROGRAM
t-this-text-holds-no-program-bdec62d5 = 此文本中没有 PROGRAM

# types are BOOL, INT, WORD, DINT, DWORD, REAL, TIME, STRING, TIMER and COUNTER
t-types-are-bool-int-word-dint-dword-real-55404504 = 类型有 BOOL、INT、WORD、DINT、DWORD、REAL、TIME、STRING、TIMER 和 COUNTER

# use Z1 or one above it
t-use-z1-or-one-above-it-5d03d6ac = 使用 Z1 或编号更大的变址寄存器

# write `:= VALUE`
t-write-value-8cec5594 = 写出 `:= VALUE`

# write `FUNCTION {name} : INT`
t-write-function-name-int-6d89d7c6 = 写成 `FUNCTION { $name } : INT`

# write `Instance(Input := value, Output => label)`
t-write-instance-input-value-output-label-f11c2b30 = 写作 `Instance(Input := value, Output => label)`

# write `PROGRAM Main`, the statements, and `END_PROGRAM`
t-write-program-main-the-statements-and-end-program-00c8f8f3 = 写出 `PROGRAM Main`、语句和 `END_PROGRAM`

# write `{function}(…)`
t-write-function-1dd7e7f9 = 写成 `{ $function }(…)`

# write `{name}(EN, {device}, 50)`
t-write-name-en-device-50-0193e53e = 写成 `{ $name }(EN, { $device }, 50)`

# write `{name}(EN{names})`
t-write-name-en-names-c1998de7 = 写成 `{ $name }(EN{ $names })`

# write `{usage}`
t-write-usage-6ad81efd = 写成 `{ $usage }`

# write for example `AT X0`, `AT D10`, `AT D10.3` or `AT K4M0`
t-write-for-example-at-x0-at-d10-at-fc1f2f95 = 例如写 `AT X0`、`AT D10`、`AT D10.3` 或 `AT K4M0`

# write the device, such as `X0`, `M10` or `D10`
t-write-the-device-such-as-x0-m10-or-fac6d558 = 写出软元件，如 `X0`、`M10` 或 `D10`

# {before}, {next}
t-before-next-f2a9d777 = { $before }、{ $next }

# {ty} has no negative values
t-ty-has-no-negative-values-fe6c76b8 = { $ty }没有负值

# {value} does not fit in {ty}
t-value-does-not-fit-in-ty-a6f88585 = { $value } 超出{ $ty }的范围
