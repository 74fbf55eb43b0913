# error
severity-error = 错误

# warning
severity-warning = 警告

# note
severity-note = 说明

# Help
help = 提示

# Note
note = 说明

# here
here = 此处

# … and { $count } more (--limit 0 prints all)
more-findings = 另有 { $count } 条未显示（--limit 0 显示全部）

# … and { $count } more locations (`--format json` lists all)
more-places = 另有 { $count } 处未显示（`--format json` 列出全部）

# for more, run `rungc explain { $code }`
more = 详情见 `rungc explain { $code }`

# the PLC reports this as error { $number }; for more, run `rungc explain { $code }`
more-of-plc = PLC 的错误代码为 { $number }；详情见 `rungc explain { $code }`

# rungc: error[{ $code }]: { $message }
# { "       " }for more, run `rungc explain { $code }`
unread =
    rungc: 错误[{ $code }]：{ $title }
    { "       " }{ $message }
    { "       " }详情见 `rungc explain { $code }`

# { $count ->
#     [one] { $count } error
#    *[other] { $count } errors
# }
errors = { $count } 个错误

# { $count ->
#     [one] { $count } warning
#    *[other] { $count } warnings
# }
warnings = { $count } 个警告

# { $count ->
#     [one] { $count } note
#    *[other] { $count } notes
# }
notes = { $count } 条说明

# ,{ " " }
comma = ，

# { "    " }Checked { $name } ({ $model }, { $steps ->
#     [one] { $steps } step
#    *[other] { $steps } steps
# }, { $devices ->
#     [one] { $devices } device
#    *[other] { $devices } devices
# }) in { $elapsed } ms
checked = { "      " }已检查 { $name }（{ $model }，{ $steps } 步，{ $devices } 个软元件），用时 { $elapsed } ms

# { "    " }Emitted { $path } ({ $model }, { $steps ->
#     [one] { $steps } step
#    *[other] { $steps } steps
# })
emitted = { "      " }已生成 { $path }（{ $model }，{ $steps } 步）

# { "   " }Measured { $path } ({ $model }, { $steps ->
#     [one] { $steps } step
#    *[other] { $steps } steps
# })
measured = { "      " }已测量 { $path }（{ $model }，{ $steps } 步）

# { "       " }Read { $title } at { $name }: { $steps ->
#     [one] { $steps } step
#    *[other] { $steps } steps
# } in { $seconds } s
read = { "      " }已读取 { $title }（{ $name }），{ $steps } 步，用时 { $seconds } s

# { $done }: { $counts }
closing = { $done }：{ $counts }

# { "      " }Failed { $name }: { $counts }
failed = { "      " }未通过 { $name }：{ $counts }

# rungc: { $name }: { $counts }
found = rungc: { $name }：{ $counts }

# rungc: { $name }: { $counts } (`{ $command }` lists them)
found-more = rungc: { $name }：{ $counts }（用 `{ $command }` 列出）

# { "        " }Open { $count ->
#     [one] { $count } question
#    *[other] { $count } questions
# } of --deep: not decided in time
open = { "      " }未判定 --deep 的 { $count } 个问题：时间内未能判定

# { "      " }Proved for this model under these assumptions:
proved = { "      " }已证明 对此模型成立，假设如下：

# The PLC reports this as error { $number }.
plc-error = PLC 的错误代码为 { $number }。

# The PLC reports this as error { $number } on FX.
plc-error-of-fx = FX 的错误代码为 { $number }。

# The PLC reports this as error { $number } on H1U and H2U, { $other } on FX.
plc-errors = H1U 和 H2U 的错误代码为 { $number }，FX 的错误代码为 { $other }。

# Wrong
wrong = 错误写法

# Right
right = 正确写法

# { $title }:
example = { $title }：

# { $title } ({ $model }):
example-of-model = { $title }（{ $model }）：

# { $code } ({ $name }): { $title }
page = { $code }（{ $name }）：{ $title }

# :{ " " }
colon = ：

# { "       " }Total { $programs ->
#     [one] { $programs } program
#    *[other] { $programs } programs
# }: { $counts }
total = { "        " }合计 { $programs } 个程序：{ $counts }

# { "       " }Total { $programs ->
#     [one] { $programs } program
#    *[other] { $programs } programs
# }: { $counts }, { $unusable } not processed
total-but = { "        " }合计 { $programs } 个程序：{ $counts }，{ $unusable } 个未处理
