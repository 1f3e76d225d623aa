// Debian's Chromium with one page, and what all tests of the page say.
import { chromium } from "playwright-core";

export async function openBrowser({ width = 1440, height = 900, more = [] } = {}) {
  const browser = await chromium.launch({
    executablePath: "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", ...more],
  });
  const page = await browser.newPage({ viewport: { width, height }, colorScheme: "light" });
  page.setDefaultTimeout(100_000);
  const errors = [];
  page.on("pageerror", ({ message }) => errors.push(message));
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  return { browser, page, errors };
}

// A line of JSON.
export const say = (values) => console.log(JSON.stringify(values));
