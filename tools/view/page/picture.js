// Saves the scene as on the screen, with its labels and a caption below.
import { css } from "./format.js";

const CAPTION = 34, PADDING = 12; // in pixels of the page

// Draws a label as the page shows it, at its place in the scene.
function drawLabel(context, label, origin) {
  const box = label.getBoundingClientRect(), style = getComputedStyle(label);
  const x = box.left - origin.left, y = box.top - origin.top;
  context.fillStyle = css("--panel");
  context.fillRect(x, y, box.width, box.height);
  context.fillStyle = style.borderLeftColor;
  context.fillRect(x, y, parseFloat(style.borderLeftWidth), box.height);
  [...label.children].forEach((line) => {
    const at = line.getBoundingClientRect(), { font, color } = getComputedStyle(line);
    context.font = font;
    context.fillStyle = color;
    context.textBaseline = "middle";
    context.fillText(line.textContent, at.left - origin.left, at.top + at.height / 2 - origin.top);
  });
}

function drawLeader(context, leader) {
  if (leader.style.display === "none") return;
  const at = (name) => leader[name].baseVal.value;
  context.strokeStyle = getComputedStyle(leader).stroke;
  context.lineWidth = 1.5;
  context.beginPath();
  context.moveTo(at("x1"), at("y1"));
  context.lineTo(at("x2"), at("y2"));
  context.stroke();
}

function drawCaption(context, caption, width, top) {
  context.fillStyle = css("--panel");
  context.fillRect(0, top, width, CAPTION);
  context.fillStyle = css("--text");
  context.font = "600 14px system-ui, sans-serif";
  context.textBaseline = "middle";
  context.fillText(caption, PADDING, top + CAPTION / 2, width - 2 * PADDING);
}

// Takes the scene's canvas and the element with its labels.
export function savePicture(view, labels, caption, name) {
  const box = view.getBoundingClientRect(), sharp = window.devicePixelRatio;
  const canvas = document.createElement("canvas");
  canvas.width = Math.round(box.width * sharp);
  canvas.height = Math.round((box.height + CAPTION) * sharp);
  const context = canvas.getContext("2d");
  context.scale(sharp, sharp);
  context.drawImage(view, 0, 0, box.width, box.height);
  for (const leader of labels.querySelectorAll("line")) drawLeader(context, leader);
  for (const label of labels.querySelectorAll(".label")) if (!label.hidden) drawLabel(context, label, box);
  drawCaption(context, caption, box.width, box.height);
  const link = document.createElement("a");
  link.download = name;
  link.href = canvas.toDataURL("image/png");
  link.click();
}
