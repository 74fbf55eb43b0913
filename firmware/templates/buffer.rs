    fn read_bfm(&mut self, unit: u16, address: u16) -> Option<i16> {
        self.module(unit)?.read(address)
    }

    fn write_bfm(&mut self, unit: u16, address: u16, value: i16) -> Option<()> {
/* BOARD */        self.module(unit)?.write(address, value)
    }
