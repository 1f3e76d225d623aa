// Opens clearance-view's page and waits until it draws a motion that a client has asked about; then closes its notice:
//   node asked.mjs URL
// Says "ready" with the first report, then the facts, a line of JSON a step.
import { openBrowser, say } from "./browser.mjs";

const [url] = process.argv.slice(2);
const { browser, page, errors } = await openBrowser();
const facts = () => page.evaluate(() => {
  const { askedPath } = window.clearance.view, notice = document.getElementById("asked");
  const colour = ({ material }) => `#${material.color.getHexString()}`;
  return {
    asked: askedPath.asked ?? null, meshes: askedPath.children.map((mesh) => ({ count: mesh.count, colour: colour(mesh) })),
    notice: notice.hidden ? "" : notice.textContent, level: notice.className,
  };
});

await page.goto(url);
await page.waitForFunction(() => window.clearance?.state.report !== undefined);
say({ ready: true, ...(await facts()) });
// The path is drawn with the question, and the violation with the answer.
await page.waitForFunction(() => {
  const { askedPath } = window.clearance.view;
  return askedPath.children.length > 0 && (askedPath.asked?.upper ?? null) !== null;
});
say(await facts());
await page.click("#asked");
say({ errors, ...(await facts()) });
await browser.close();
