// Runs a flow in Node-RED itself, without its editor, against `rungc run --modbus-tcp`: node nodered.js PORT.
//
// The nodes are those of node-red-contrib-modbus. The flow writes D0 and D1, and reads D0 to D2 every 100 ms; the program
// adds the first two to the third.
"use strict";
const assert = require("node:assert");
const fs = require("node:fs");
const os = require("node:os");
const path = require("node:path");
const RED = require("node-red");

const PATIENCE_MS = 300_000;
const tab = { id: "tab", type: "tab", label: "PLC" };
// Nodes without a place would be taken for settings of others.
const place = { z: "tab", x: 1, y: 1 };
const common = { ...place, server: "client", dataType: "HoldingRegister", adr: "0" };
const flow = [
  tab,
  {
    id: "client", type: "modbus-client", clienttype: "tcp", tcpHost: "127.0.0.1", tcpPort: process.argv[2], tcpType: "DEFAULT",
    unit_id: "1", commandDelay: "1", clientTimeout: "1000", reconnectOnTimeout: true, reconnectTimeout: "1000",
    bufferCommands: true, parallelUnitIdsAllowed: true,
  },
  { ...place, id: "inject", type: "inject", props: [{ p: "payload" }], payload: "[20,22]", payloadType: "json", repeat: "0.5", once: true, wires: [["write"]] },
  { ...common, id: "write", type: "modbus-write", name: "write", dataType: "MHoldingRegisters", quantity: "2", wires: [[], []] },
  { ...common, id: "read", type: "modbus-read", name: "read", quantity: "3", rate: "100", rateUnit: "ms", wires: [["check"], []] },
  { ...place, id: "check", type: "function", func: "global.get('seen')(msg.payload);", outputs: 0, wires: [] },
];

const folder = fs.mkdtempSync(path.join(os.tmpdir(), "nodered-"));
const end = (code) => {
  fs.rmSync(folder, { recursive: true, force: true });
  process.exit(code);
};
fs.writeFileSync(path.join(folder, "flows.json"), JSON.stringify(flow));
let last = null;
const seen = (values) => {
  last = values;
  if (values[2] === 42) {
    assert.deepStrictEqual(values, [20, 22, 42]);
    console.log("the flow has read what it wrote, and the sum");
    end(0);
  }
};
RED.init({
  userDir: folder, flowFile: "flows.json", httpAdminRoot: false, httpNodeRoot: false, credentialSecret: false,
  functionGlobalContext: { seen }, telemetry: { enabled: false, updateNotification: false },
});
RED.start().catch((error) => {
  console.error(error);
  end(1);
});
setTimeout(() => {
  console.error("the last that was read:", last);
  end(1);
}, PATIENCE_MS);
