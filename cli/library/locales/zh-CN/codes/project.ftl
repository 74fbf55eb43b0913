# this line of rungc.toml is not TOML
# rungc.toml holds the settings of a project as TOML: tables in brackets (`[check]`), each with one key and value per line (`allow = ["W0203"]`). Texts are quoted.
E0040 = rungc.toml 的此行不是 TOML
    .text = rungc.toml 用 TOML 存放工程的设置：方括号中的表（`[check]`），其下每行一个键和值（`allow = ["W0203"]`）。文本加双引号。

# rungc.toml has no such table or key
# An unknown table or key is rejected, because a misspelt setting would otherwise be ignored. The help lists the valid keys; `rungc book project` explains them.
E0041 = rungc.toml 没有此表或键
    .text = 未知的表或键会被拒绝，否则拼错的设置会被忽略。提示列出有效的键；`rungc book project` 说明各个键。

# a value in rungc.toml that does not fit its key
# The value has the wrong type for the key, names something that does not exist (a model, a warning, a target), or contradicts another key in the file.
E0042 = rungc.toml 中的值与键不符
    .text = 值的类型与键不符，或写了不存在的名称（机型、警告、目标平台），或与文件中的其他键矛盾。

# a connection of `[io]` in rungc.toml cannot be made as it is described
# A table `[io.NAME]` connects devices of a running program to remote I/O, a broker, pins or files. It has one key that says to what (`modbus-tcp`, `modbus-rtu`, `mqtt`, `gpio`, `files` or `console`), options, and rows: ranges of devices with the direction and the place at the other end (`X000-X007 = "read inputs 0"`). No device takes its value from two places, and no two rows write the same place. `rungc book linux` explains the keys.
E0820 = rungc.toml 中 `[io]` 的连接不能按描述建立
    .text = 表 `[io.NAME]` 把运行中的程序的软元件连接到远程输入输出、MQTT 服务器、引脚或文件。表中有一个键说明与什么连接（`modbus-tcp`、`modbus-rtu`、`mqtt`、`gpio`、`files` 或 `console`），另有选项和各行：软元件的范围、方向和另一端的位置（`X000-X007 = "read inputs 0"`）。同一软元件不能从两处取值，两行也不能写同一位置。`rungc book linux` 说明各个键。
