# a test file with a mistake
# A file `*.plctest.toml` lists cases: a program, what is set in each step, and what is expected then. It has a mistake at this place: TOML that cannot be read, a key that does not exist there, or a value that does not fit. An unknown key is rejected, because a misspelt one would otherwise be ignored. No case of the run is executed before all files are right. `rungc book test-files` explains the keys.
E0880 = 测试文件有错误
    .text = `*.plctest.toml` 文件列出测试用例：程序、每一步设置什么、然后预期什么。此处有错误：TOML 无法读取，键不存在，或值不合适。未知的键会被拒绝，否则拼错的键会被忽略。全部文件正确之前，不执行任何用例。`rungc book test-files` 说明各个键。

# the description of a machine has a mistake
# A file `*.machine.toml` describes axes, cylinders, delays and processes that follow the outputs of the PLC and drive its inputs. It has a mistake at this place, or names a terminal that the model does not have. `rungc book machines` explains the keys.
E0881 = 机械描述有错误
    .text = `*.machine.toml` 文件描述轴、气缸、延时和过程，它们跟随 PLC 的输出，并驱动其输入。此处有错误，或写了机型没有的端子。`rungc book machines` 说明各个键。

# the description of a board has a mistake
# The file that `--board` names describes a microcontroller and what is at its pins. It has a mistake at this place: a key that does not exist, a pin that is used twice, or memory that does not fit. `rungc book boards` explains the keys, and `rungc boards BOARD --toml` writes the description of a known board to begin with.
E0882 = 电路板描述有错误
    .text = `--board` 指定的文件描述单片机及其引脚的连接。此处有错误：键不存在，引脚重复使用，或存储器不合适。`rungc book boards` 说明各个键；`rungc boards BOARD --toml` 写出已知电路板的描述，可以由此开始。
