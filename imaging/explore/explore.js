"use strict";
(() => {
  const {points, figures, keys, more, start, first} = JSON.parse(document.getElementById("points").textContent);
  const at = id => document.getElementById(id), style = getComputedStyle(document.documentElement);
  const colour = name => style.getPropertyValue(name).trim();
  const number = value => typeof value === "number" ? String(+value.toPrecision(4)) : value === null ? "-" : String(value);
  const limits = {}, brushed = {};
  const within = p => Object.entries(limits).every(([name, limit]) => more.includes(name) ? p.figures[name] >= limit : p.figures[name] <= limit);
  const kept = p => within(p) && Object.entries(brushed).every(([name, ranges]) => ranges.some(([low, high]) => place(p, name) >= low && place(p, name) <= high));
  // A value of a key that is a text is its place among the texts
  const texts = Object.fromEntries(keys.map(name => [name, points.some(p => typeof p.values[name] === "string") ? [...new Set(points.map(p => String(p.values[name])))].sort() : null]));
  const place = (p, name) => name in p.figures ? p.figures[name] : texts[name] ? texts[name].indexOf(String(p.values[name])) : p.values[name];
  const paper = () => ({paper_bgcolor:"rgba(0,0,0,0)", plot_bgcolor:"rgba(0,0,0,0)", font:{color:colour("--ink"), size:12}});

  for (const [id, chosen] of [["across", start[0]], ["up", start[1]]]) {
    for (const name of figures) at(id).add(new Option(name, name, false, name === chosen));
    at(id).addEventListener("change", plane);
  }
  for (const name of figures) {
    const label = document.createElement("label"), input = document.createElement("input");
    input.type = "number"; input.step = "any";
    label.append(`${name} ${more.includes(name) ? "at least" : "at most"} `, input);
    input.addEventListener("input", () => { if (input.value === "") delete limits[name]; else limits[name] = +input.value; plane(); parallel(); });
    at("limits").append(label);
  }
  at("limits").addEventListener("submit", event => event.preventDefault());

  function trace(name, chosen, marker) {
    const [x, y] = [at("across").value, at("up").value];
    return {type:"scatter", mode:"markers", name, marker, customdata:chosen.map(p => p.point), x:chosen.map(p => p.figures[x]), y:chosen.map(p => p.figures[y]),
      hovertemplate:`%{customdata}<br>${x} %{x:.4g}<br>${y} %{y:.4g}<extra></extra>`};
  }
  function plane() {
    const shown = points.filter(kept), bar = colour("--bar");
    const traces = [
      trace("evaluated", shown.filter(p => !p.front && p.point !== "thesis"), {color:"rgba(0,0,0,0)", size:8, line:{color:bar, width:1}}),
      trace("front", shown.filter(p => p.front), {color:bar, size:10}),
      trace("thesis's sensor", shown.filter(p => p.point === "thesis"), {color:colour("--bad"), size:14, symbol:"star"})];
    const axis = id => ({title:{text:at(id).value}, gridcolor:colour("--line"), zeroline:false, automargin:true});
    Plotly.react("plane", traces, {...paper(), xaxis:axis("across"), yaxis:axis("up"), margin:{l:60, r:10, t:10, b:50}, hovermode:"closest",
      legend:{orientation:"h", y:1.08}}, {responsive:true, displayModeBar:false});
  }
  function parallel() {
    const shown = points.filter(within);
    const dimensions = [...keys, ...figures].map(name => ({label:name.replace(/^.*\./, ""), values:shown.map(p => place(p, name)),
      constraintrange:brushed[name], ...(texts[name] ? {tickvals:texts[name].map((_, i) => i), ticktext:texts[name]} : {})}));
    const values = shown.map(p => p.figures[figures[0]]);
    Plotly.react("parallel", [{type:"parcoords", dimensions, line:{color:values, colorscale:"Viridis", showscale:true, colorbar:{title:{text:figures[0]}, thickness:12}},
      unselected:{line:{opacity:0.08}}}], {...paper(), margin:{l:60, r:40, t:50, b:20}}, {responsive:true, displayModeBar:false});
  }
  function show(point) {
    const p = points.find(p => p.point === point), aside = at("shown"), make = (tag, text) => Object.assign(document.createElement(tag), {textContent:text});
    const image = Object.assign(document.createElement("img"), {src:"data:image/png;base64," + p.picture, alt:`picture that the sensor ${point} gives`});
    const table = document.createElement("table");
    for (const [name, value] of [...Object.entries(p.figures), ...Object.entries(p.values)]) {
      const row = table.insertRow();
      row.insertCell().textContent = name; row.insertCell().textContent = number(value);
    }
    aside.replaceChildren(make("h3", `${point}${p.front ? ", on the front" : ""}`), image, table, make("p", ""), make("code", p.command));
    if (p.toml) aside.append(make("h3", "sensor.toml"), make("pre", p.toml));
  }

  plane(); parallel();
  if (first) show(first);
  Plotly.Plots.resize(at("plane"));
  for (const event of ["plotly_hover", "plotly_click"]) at("plane").on(event, ({points:[chosen]}) => show(chosen.customdata));
  at("parallel").on("plotly_restyle", () => {
    const names = [...keys, ...figures];
    for (const [i, dimension] of at("parallel").data[0].dimensions.entries()) {
      const range = dimension.constraintrange;
      if (range) brushed[names[i]] = Array.isArray(range[0]) ? range : [range]; else delete brushed[names[i]];
    }
    plane();
  });
})();
