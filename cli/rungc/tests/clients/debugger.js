// Debugs a program with the client that the authors of the Debug Adapter Protocol test adapters with.
// Arguments: rungc, a list, the same program as PLCopen XML.

const assert = require("node:assert/strict");
const { DebugClient } = require("@vscode/debugadapter-testsupport");

const [rungc, list, xml] = process.argv.slice(2);

/** Runs `work` with an adapter. */
async function session(work) {
  const client = new DebugClient(rungc, "dap", "rungc");
  await client.start();
  try {
    await work(client);
  } finally {
    await client.stop();
  }
}

const threadId = 1;

/** Steps, and waits until the program has stopped for a reason. */
async function step(client, command, reason = "step") {
  const stopped = client.waitForEvent("stopped");
  const [event] = await Promise.all([stopped, client[`${command}Request`]({ threadId })]);
  assert.equal(event.body.reason, reason);
  const { body } = await client.stackTraceRequest({ threadId });
  return body.stackFrames[0];
}

async function value(client, expression) {
  return (await client.evaluateRequest({ expression, context: "watch" })).body.result;
}

/** Breakpoints, steps in both directions, variables. */
async function text(client) {
  const launch = { program: list, inputs: { Start: true }, realTime: false };
  await client.hitBreakpoint(launch, { path: list, line: 6 });
  assert.equal(await value(client, "Y000"), "off");
  const next = await step(client, "next");
  assert.ok(next.line > 6, next.name);
  assert.equal(await value(client, "Y000"), "on");
  await step(client, "stepBack");
  assert.equal(await value(client, "Y000"), "off");
  const { body } = await client.scopesRequest({ frameId: 1 });
  const scope = body.scopes.find(({ name }) => name === "Inputs");
  const { variablesReference } = scope;
  const inputs = (await client.variablesRequest({ variablesReference })).body.variables;
  assert.deepEqual(inputs.map(({ name }) => name), ["X000 Start", "X001"]);
  const set = await client.setVariableRequest({ variablesReference, name: "X000 Start", value: "off" });
  assert.equal(set.body.value, "off");
  await step(client, "continue", "breakpoint");
  assert.equal(await value(client, "M0"), "on");
  const why = await client.evaluateRequest({ expression: "why Y000", context: "repl" });
  assert.match(why.body.result, /Y000/);
}

/** Changes of devices, back in time. */
async function data(client) {
  const launch = { program: list, stopOnEntry: true, realTime: false };
  await Promise.all([client.configurationSequence(), client.launch(launch), client.waitForEvent("stopped")]);
  const { body } = await client.dataBreakpointInfoRequest({ name: "Y000" });
  await client.setDataBreakpointsRequest({ breakpoints: [{ dataId: body.dataId }] });
  await client.evaluateRequest({ expression: "X000 = on", context: "repl" });
  await step(client, "continue", "data breakpoint");
  assert.equal(await value(client, "Y000"), "on");
  await step(client, "stepOut");
  await step(client, "reverseContinue", "data breakpoint");
  await step(client, "reverseContinue", "entry");
  await client.terminateRequest();
}

/** A program that is not a text has a listing. */
async function listing(client) {
  const launch = { program: xml, stopOnEntry: true };
  await Promise.all([client.configurationSequence(), client.launch(launch), client.waitForEvent("stopped")]);
  const { source } = (await client.stackTraceRequest({ threadId })).body.stackFrames[0];
  const { content } = (await client.sourceRequest({ source, sourceReference: source.sourceReference })).body;
  const line = 1 + content.split("\n").findIndex((text) => /OUT\s+Y000/.test(text));
  assert.ok(line > 0, content);
  const { breakpoints } = (await client.setBreakpointsRequest({ source, breakpoints: [{ line }] })).body;
  assert.deepEqual([breakpoints[0].verified, breakpoints[0].line], [true, line]);
  const stop = await step(client, "continue", "breakpoint");
  assert.equal(stop.line, line);
}

(async () => {
  await session(text);
  await session(data);
  await session(listing);
  console.log("3 sessions");
})().catch((error) => {
  console.error(error);
  process.exit(1);
});
