// A page of `rungc serve --page --machine` in WebKit, the engine of Safari: WebKitGTK's MiniBrowser, driven over WebDriver.
const { spawn } = require("child_process");
const net = require("net");
const { Builder, By } = require("selenium-webdriver");
const { slide } = require("./slide.js");

const [url, pictures] = process.argv.slice(2);

// A port that is free, or was a moment ago.
const freePort = () => new Promise((resolve) => {
  const server = net.createServer();
  server.listen(0, "127.0.0.1", () => {
    const { port } = server.address();
    server.close(() => resolve(port));
  });
});

const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

// Whether something listens.
const listens = (port) => new Promise((resolve) => {
  const socket = net.connect(port, "127.0.0.1");
  socket.on("connect", () => resolve(true) || socket.destroy());
  socket.on("error", () => resolve(false));
});

async function use(port) {
  const options = { binary: process.env.RUNGC_WEBKIT, args: ["--automation"] };
  const capabilities = { browserName: "MiniBrowser", "webkitgtk:browserOptions": options };
  const driver = await new Builder().usingServer(`http://127.0.0.1:${port}`).withCapabilities(capabilities).build();
  try {
    await driver.manage().window().setRect({ width: 1280, height: 800 });
    await driver.get(url);
    await driver.executeScript(() => {
      window.noted = [];
      addEventListener("error", ({ message }) => window.noted.push(message));
      addEventListener("unhandledrejection", ({ reason }) => window.noted.push(String(reason)));
    });
    const report = await slide({
      settle: (test, ...given) => driver.wait(() => driver.executeScript(test, ...given), 300_000, `${test}`, 100),
      read: (what) => driver.executeScript(what),
      fill: async (place, text) => {
        const field = await driver.findElement(By.css(place));
        await field.clear();
        await field.sendKeys(text);
      },
      press: async (name) => (await driver.findElement(By.xpath(`//button[@aria-label="${name}" or (not(@aria-label) and normalize-space()="${name}")]`))).click(),
    });
    if (pictures) require("fs").writeFileSync(`${pictures}/webkit.png`, await driver.takeScreenshot(), "base64");
    // Safari says so of itself, too; what else it says depends on the version.
    const agent = await driver.executeScript(() => navigator.userAgent);
    const browser = /AppleWebKit/.test(agent) && !/Chrom/.test(agent) ? "webkit" : agent;
    console.log(JSON.stringify({ browser, ...report, errors: await driver.executeScript(() => window.noted) }));
  } finally {
    await driver.quit();
  }
}

(async () => {
  const port = await freePort();
  const server = spawn("xvfb-run", ["-a", "WebKitWebDriver", `--port=${port}`], { stdio: ["ignore", "inherit", "inherit"], detached: true });
  try {
    for (let tries = 0; !(await listens(port)); tries++) {
      if (tries > 6000) throw new Error("WebKitWebDriver does not listen");
      await pause(100);
    }
    await use(port);
  } finally {
    process.kill(-server.pid);
  }
})().catch((error) => {
  console.error(error);
  process.exit(1);
});
