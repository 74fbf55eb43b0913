# a bound is for the operand exactly as the program writes it
t-a-bound-is-for-the-operand-exactly-as-391c9115 = 范围只适用于与程序写法完全相同的操作数

# compare {index} before, or bound the operand in rungc.toml: `[index]`, `{operand} = "{first}-{last}"`
t-compare-index-before-or-bound-the-operand-in-7d3ee641 = 在此之前对 { $index } 进行比较，或在 rungc.toml 中限定操作数的范围：`[index]`、`{ $operand } = "{ $first }-{ $last }"`

# CPU type {cpu} is not among the models; {id}
t-cpu-type-cpu-is-not-among-the-models-d9d2b8e3 = CPU 类型 { $cpu } 不是支持的机型；{ $id }

# CPU type {cpu} is not known; {id}
t-cpu-type-cpu-is-not-known-id-a80e94df = CPU 类型 { $cpu } 未知；{ $id }

# how the PLC stores others is not known
t-how-the-plc-stores-others-is-not-known-55e97e24 = PLC 如何存放其他字符，尚不清楚

# it is compiled as {id}
t-it-is-compiled-as-id-461fbd10 = 按 { $id } 编译

# little is known of {index} here
t-little-is-known-of-index-here-ad937a03 = 此处 { $index } 的取值范围不明

# `--model` or rungc.toml says {chosen}, but the program names CPU type {cpu}
t-model-or-rungc-toml-says-chosen-but-the-bd3d4612 = `--model` 或 rungc.toml 选择了 { $chosen }，但程序写明的 CPU 类型为 { $cpu }

# `--model` takes {names}
t-model-takes-names-ad238c90 = `--model` 可用：{ $names }

# `{name}` cannot be compiled with `{kind}`
t-name-cannot-be-compiled-with-kind-3390e223 = `{ $name }` 不能用操作数 `{ $kind }` 编译

# no device {prefix} has an index here
t-no-device-prefix-has-an-index-here-f6ad0eb7 = 此处没有带变址的 { $prefix } 软元件

# `{operand}` can reach {devices} devices, which take {bytes} bytes of memory
t-operand-can-reach-devices-devices-which-take-bytes-6e8b63f5 = `{ $operand }` 可以访问 { $devices } 个软元件，占用 { $bytes } 字节的内存

# `{operand}` has a bound, but no instruction has this operand
t-operand-has-a-bound-but-no-instruction-has-f030c8c2 = 为 `{ $operand }` 设置了范围，但没有指令使用此操作数

# `{operand}` is bounded to {from} to {to}, which {title} does not have
t-operand-is-bounded-to-from-to-to-which-fbb5a405 = `{ $operand }` 的范围设为 { $from }～{ $to }，而 { $title } 没有这些软元件

# the label is in a loop, a state or a routine that this jump is not in
t-the-label-is-in-a-loop-a-state-466b65ed = 标号位于循环、状态、子程序或中断程序中，而此跳转不在其中

# there are {ranges}
t-there-are-ranges-e2cc258b = 可用的有 { $ranges }

# this operand is `{device}{index}`
t-this-operand-is-device-index-b17b7df4 = 此操作数是 `{ $device }{ $index }`

# without the setting it is compiled as {named}
t-without-the-setting-it-is-compiled-as-named-eb91c503 = 没有此设置时，按 { $named } 编译
