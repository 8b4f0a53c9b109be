// Pictures: the buttons, a double click, or Ctrl and the wheel zoom; a drag moves. Those of one .linked do so together,
// and each shows the value under the pointer, read from its own colour bar.
const clamp = (value, low, high) => Math.min(high, Math.max(low, value));

function pixels(image) {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [image.naturalWidth, image.naturalHeight];
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.drawImage(image, 0, 0);
  return context;
}

function valueAt(stage, column, row) {
  const bar = stage.parentElement.querySelector(".bar");
  if (!bar) return "";
  stage.image ??= pixels(stage.querySelector("img"));
  bar.colours ??= pixels(bar).getImageData(0, 0, bar.naturalWidth, 1).data;
  const found = stage.image.getImageData(column, row, 1, 1).data;
  let best = 0, least = Infinity;
  for (let i = 0; i < bar.colours.length; i += 4) {
    const far = Math.hypot(...[0, 1, 2].map(k => bar.colours[i + k] - found[k]));
    if (far < least) [best, least] = [i / 4, far];
  }
  const { low, high, unit } = bar.dataset, share = best / (bar.naturalWidth - 1);
  return least > 40 ? ": not read" : `: ${Number((+low + share * (high - low)).toPrecision(3))} ${unit}`;
}

function text(stage, x, y) {
  const { width, height, unit } = stage.dataset;
  if (unit) return `x ${(x * width).toFixed(1)} ${unit}, y ${((1 - y) * height).toFixed(1)} ${unit}`;
  const [column, row] = [Math.floor(x * width), Math.floor(y * height)];
  return `row ${row}, column ${column}${valueAt(stage, column, row)}`;
}

for (const group of document.querySelectorAll(".linked, .stage")) {
  if (!group.matches(".linked") && group.closest(".linked")) continue;
  const stages = group.matches(".stage") ? [group] : [...group.querySelectorAll(".stage")];
  let zoom = 1, x = 0, y = 0, held = null;
  const show = () => {
    [x, y] = [clamp(x, 1 - zoom, 0), clamp(y, 1 - zoom, 0)];
    for (const stage of stages) {
      for (const [name, value] of Object.entries({ "--zoom": zoom, "--x": x, "--y": y })) stage.style.setProperty(name, value);
      stage.classList.toggle("zoomed", zoom > 1);
    }
  };
  const zoomTo = (next, px, py) => {
    next = clamp(next, 1, 64);
    [x, y, zoom] = [px - (px - x) * next / zoom, py - (py - y) * next / zoom, next];
    show();
  };
  const at = event => {
    const box = event.currentTarget.getBoundingClientRect();
    return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
  };
  for (const stage of stages) {
    const buttons = stage.appendChild(Object.assign(document.createElement("div"), { className: "buttons" }));
    for (const [sign, title, next] of [["+", "nearer", z => 2 * z], ["−", "farther", z => z / 2], ["⌂", "all", () => 1]]) {
      const button = buttons.appendChild(Object.assign(document.createElement("button"), { textContent: sign, title }));
      button.onclick = () => zoomTo(next(zoom), 0.5, 0.5);
    }
    buttons.onpointerdown = buttons.ondblclick = event => event.stopPropagation();
    stage.ondblclick = event => zoomTo(2 * zoom, ...at(event));
    stage.addEventListener("wheel", event => {
      if (!event.ctrlKey && !event.metaKey) return;      // the wheel alone is the page's
      event.preventDefault();
      zoomTo(zoom * Math.exp(-event.deltaY / 300), ...at(event));
    }, { passive: false });
    stage.onpointerdown = event => {
      const [px, py] = at(event);
      if (zoom > 1) { held = [px - x, py - y]; stage.setPointerCapture(event.pointerId); }
    };
    stage.onpointerup = stage.onpointercancel = () => { held = null; };
    stage.onpointermove = event => {
      const [px, py] = at(event);
      if (held) { [x, y] = [px - held[0], py - held[1]]; show(); }
      const [sx, sy] = [(px - x) / zoom, (py - y) / zoom];
      if (stage.matches(".paper")) return;               // a chart
      if (sx < 0 || sy < 0 || sx >= 1 || sy >= 1) return;
      for (const other of stages) other.querySelector("output").textContent = text(other, sx, sy);
    };
    stage.onpointerleave = () => { for (const s of stages) s.querySelector("output").textContent = ""; };
  }
}

// A slider through views, row by row and back, so that the next view is a neighbour
for (const slider of document.querySelectorAll(".views input")) {
  const views = slider.closest(".views"), columns = +views.dataset.columns, labels = views.dataset.labels?.split("|");
  slider.oninput = () => {
    const v = Math.floor(slider.value / columns), along = slider.value % columns, u = v % 2 ? columns - 1 - along : along;
    views.style.setProperty("--u", u);
    views.style.setProperty("--v", v);
    const signed = n => (n > 0 ? "+" : n < 0 ? "−" : "") + Math.abs(n), middle = Math.floor(columns / 2);
    views.querySelector("b").textContent = labels ? labels[slider.value] : `v ${signed(v - middle)}, u ${signed(u - middle)}`;
  };
  slider.oninput();
}

for (const box of document.querySelectorAll(".key input")) {
  const image = document.getElementById(box.dataset.layer), set = () => { image.hidden = !box.checked; };
  box.onchange = set;
  set();
}
