// Debian's Chromium with one page, and what all tests of the page say. A suite has one Chromium, which CLEARANCE_BROWSER
// names:
//   node browser.mjs      starts it and says its address
import { chromium } from "playwright-core";

if (process.argv[1].endsWith("/browser.mjs")) {
  const server = await chromium.launchServer({
    executablePath: "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
           "--host-resolver-rules=MAP rebound.example 127.0.0.1"],
  });
  console.log(server.wsEndpoint());
}

export async function openBrowser({ width = 1440, height = 900 } = {}) {
  const browser = await chromium.connect(process.env.CLEARANCE_BROWSER);
  const page = await browser.newPage({ viewport: { width, height }, colorScheme: "light" });
  page.setDefaultTimeout(100_000);
  const errors = [];
  page.on("pageerror", ({ message }) => errors.push(message));
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  return { browser, page, errors };
}

// A line of JSON.
export const say = (values) => console.log(JSON.stringify(values));
