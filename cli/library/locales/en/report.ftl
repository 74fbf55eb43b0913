severity-error = error

severity-warning = warning

severity-note = note

help = Help

note = Note

here = here

more-findings = … and { $count } more (--limit 0 prints all)

more-places = … and { $count } more locations (`--format json` lists all)

more = for more, run `rungc explain { $code }`

more-of-plc = the PLC reports this as error { $number }; for more, run `rungc explain { $code }`

unread =
    rungc: error[{ $code }]: { $message }
    { "       " }for more, run `rungc explain { $code }`

errors = { $count ->
        [one] { $count } error
       *[other] { $count } errors
    }

warnings = { $count ->
        [one] { $count } warning
       *[other] { $count } warnings
    }

notes = { $count ->
        [one] { $count } note
       *[other] { $count } notes
    }

comma = ,{ " " }

checked =
    { "    " }Checked { $name } ({ $model }, { $steps ->
        [one] { $steps } step
       *[other] { $steps } steps
    }, { $devices ->
        [one] { $devices } device
       *[other] { $devices } devices
    }) in { $elapsed } ms

emitted =
    { "    " }Emitted { $path } ({ $model }, { $steps ->
        [one] { $steps } step
       *[other] { $steps } steps
    })

measured =
    { "   " }Measured { $path } ({ $model }, { $steps ->
        [one] { $steps } step
       *[other] { $steps } steps
    })

read =
    { "       " }Read { $title } at { $name }: { $steps ->
        [one] { $steps } step
       *[other] { $steps } steps
    } in { $seconds } s

closing = { $done }: { $counts }

failed = { "      " }Failed { $name }: { $counts }

found = rungc: { $name }: { $counts }

found-more = rungc: { $name }: { $counts } (`{ $command }` lists them)

open = { "        " }Open { $count ->
        [one] { $count } question
       *[other] { $count } questions
    } of --deep: not decided in time

proved = { "      " }Proved for this model under these assumptions:

plc-error = The PLC reports this as error { $number }.

plc-error-of-fx = The PLC reports this as error { $number } on FX.

plc-errors = The PLC reports this as error { $number } on H1U and H2U, { $other } on FX.

wrong = Wrong

right = Right

example = { $title }:

example-of-model = { $title } ({ $model }):

page = { $code } ({ $name }): { $title }

colon = :{ " " }

total = { "       " }Total { $programs ->
        [one] { $programs } program
       *[other] { $programs } programs
    }: { $counts }

total-but = { "       " }Total { $programs ->
        [one] { $programs } program
       *[other] { $programs } programs
    }: { $counts }, { $unusable } not processed
