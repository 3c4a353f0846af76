"use strict";
// Everything that is text: numbers, findings, kernels, commands, and the map of each image's local store.

/** An element with attributes and children; strings become text, never markup. */
function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key === "style") made.style.cssText = value;
    else if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else made.setAttribute(key, value);
  }
  made.append(...children);
  return made;
}

function swatch(colour) { return element("span", {class: "swatch", style: `background:${colour}`, "aria-hidden": "true"}); }

/** A table from a list of column titles and of rows of cells (texts or elements); the first cell heads its row. */
function fillTable(table, titles, rows) {
  table.replaceChildren(
      element("thead", {}, element("tr", {}, ...titles.map((title) => element("th", {scope: "col"}, title)))),
      element("tbody", {}, ...rows.map(([first, ...rest]) => element("tr", {}, element("th", {scope: "row"}, first),
          ...rest.map((cell) => cell instanceof HTMLTableCellElement ? cell : element("td", {}, cell))))));
}

function facts(list) {
  return element("dl", {class: "facts"}, ...list.flatMap(([word, value]) => [element("dt", {}, word), element("dd", {}, String(value))]));
}

function showSummary(list, trace) {
  const span = trace.end - trace.begin, spes = trace.spes.length;
  const jobs = trace.count("jobs"), failed = trace.total((spe) => spe.jobs.failed.reduce((a, b) => a + b, 0));
  const bytes = trace.total((spe) => spe.commands.bytes.reduce((a, b) => a + b, 0));
  const busy = trace.total((spe) => spe.jobRow.busy.at(Infinity)), waiting = trace.total((spe) => spe.jobWaits.busy.at(Infinity));
  const tile = (name, value, note, bad = false) =>
      element("div", bad ? {class: "bad"} : {}, element("dt", {}, name), element("dd", {}, value, element("small", {}, note)));
  list.replaceChildren(
      tile("Duration", format.time(span), plural(spes, "SPE")),
      tile("Jobs", format.count(jobs), failed > 0 ? `${format.count(failed)} failed` : `of ${plural(trace.kernels.length, "kernel")}`, failed > 0),
      tile("DMA commands", format.count(trace.count("commands")), `${format.bytes(bytes)} moved`),
      tile("Bandwidth", format.rate(bytes / span * 1e9), "mean, all SPEs"),
      tile("SPEs busy", format.percent(busy / span / spes), "with a job"),
      tile("Waiting", format.percent(busy > 0 ? waiting / busy : 0), "of the busy time"),
      tile("Findings", format.count(trace.findings.reduce((sum, finding) => sum + finding.count, 0)), trace.findings.length > 0 ? "mistakes of checked kernels" : "none recorded", trace.findings.length > 0));
}

/** What the trace lacks, above everything else. */
function showNotes(box, trace) {
  const notes = [];
  for (const spe of trace.spes) {
    const lost = Object.entries(spe.dropped).filter(([, count]) => count > 0).map(([kind, count]) => `${format.count(count)} ${kind}`);
    if (lost.length > 0) notes.push(`SPE ${spe.number}: ${lost.join(", ")} past the trace's limit are not recorded.`);
  }
  if (trace.count("jobs") === 0) notes.push("No job ended while this was recorded.");
  box.replaceChildren(...notes.map((note) => element("p", {class: "note", role: "note"}, note)));
}

/** The same mistake once, with how often it happened. @param show  called with the first of them. */
function showFindings(box, trace, show) {
  if (trace.findings.length === 0) {
    box.replaceChildren(element("p", {}, "None. Only kernels that run with --checked report findings."));
    return;
  }
  const kinds = new Map();
  for (const finding of trace.findings) {
    const key = JSON.stringify([finding.rule, finding.kernel, finding.place]);
    const kind = kinds.get(key) ?? {first: finding, count: 0, spes: new Set()};
    kind.count += finding.count;
    kind.spes.add(finding.spe);
    kinds.set(key, kind);
  }
  const rows = [...kinds.values()].map(({first, count, spes}) => [
    element("code", {class: "bad-text"}, first.rule),
    element("td", {class: "left"}, first.kernel),
    element("td", {class: "place"}, element("code", {}, first.place || "unknown")),
    format.count(count),
    [...spes].sort().join(", "),
    element("td", {class: "wrap"}, first.message),
    element("button", {type: "button", onclick: () => show(first), "aria-label": `Show ${first.rule} on the timeline`}, format.time(first.when - trace.begin)),
  ]);
  const table = element("table");
  fillTable(table, ["rule", "kernel", "place", "times", "SPE", "the first of them", "show"], rows);
  for (const column of [1, 2, 5]) table.querySelectorAll("thead th")[column].classList.add("left");
  box.replaceChildren(table);
}

/** Events of a kind by name: how many, how long, and what else is asked for. */
function byName(trace, kind, more = () => 0) {
  const groups = new Map();
  for (const spe of trace.spes) {
    const columns = spe[kind];
    for (let i = 0; i < columns.count; ++i) {
      const name = spe.name(columns, i), duration = columns.end[i] - columns.begin[i];
      let group = groups.get(name);
      if (!group) groups.set(name, group = {name, count: 0, total: 0, least: Infinity, most: 0, more: 0});
      ++group.count;
      group.total += duration;
      group.least = Math.min(group.least, duration);
      group.most = Math.max(group.most, duration);
      group.more += more(columns, i);
    }
  }
  return [...groups.values()].sort((a, b) => b.total - a.total);
}

function showKernels(table, trace, timeline) {
  const groups = byName(trace, "jobs", (jobs, i) => jobs.failed[i]);
  const all = groups.reduce((sum, group) => sum + group.total, 0);
  fillTable(table, ["kernel", "runs", "failed", "mean", "shortest", "longest", "total", "share"], groups.map((group) => [
    element("span", {}, swatch(timeline.kernelColour(group.name)), group.name), format.count(group.count),
    element("td", group.more > 0 ? {class: "failed"} : {}, format.count(group.more)), format.time(group.total / group.count),
    format.time(group.least), format.time(group.most), format.time(group.total), format.percent(all > 0 ? group.total / all : 0)]));
}

function showCommands(table, trace) {
  fillTable(table, ["command", "issued", "moved", "mean size", "mean time", "longest"],
            byName(trace, "commands", (commands, i) => commands.bytes[i]).map((group) => [
    element("code", {}, group.name), format.count(group.count), format.bytes(group.more), format.bytes(group.more / group.count),
    format.time(group.total / group.count), format.time(group.most)]));
}

const kStoreBytes = 256 * 1024;

/** A bar of local store from address 0 to `end`, to scale. */
function storeBar(ranges, end, colourOf, className) {
  const bar = element("div", {class: className, "aria-hidden": "true"});
  for (const {name, begin, bytes} of ranges) {
    const text = `${name}: ${format.address(begin)}, ${format.store(bytes)}`;
    const wide = bytes / end > 0.012 * (name.length + 1);
    bar.append(element("span", {class: name === "free" ? "free" : "", title: text,
      style: `left:${100 * begin / end}%;width:${100 * bytes / end}%;padding-left:${wide ? 4 : 0}px;background:${colourOf(name)}`}, wide ? name : ""));
  }
  return bar;
}

/** Addresses along a bar: the end, and powers of two that leave it room. */
function storeAxis(end) {
  const axis = element("div", {class: "axis", "aria-hidden": "true"});
  const step = 2 ** Math.ceil(Math.log2(end / 6));
  for (let at = 0; at < end - step / 3; at += step) axis.append(element("span", {style: `left:${100 * at / end}%`}, at === 0 ? "0" : format.store(at)));
  axis.append(element("span", {style: "left:100%"}, format.store(end)));
  return axis;
}

function showStore(image) {
  const colourOf = (kind) => colours.of(kind === "text" ? "text-section" : kind);
  const stack = image.sections.find((section) => section.name === "stack");
  const whole = storeBar(image.sections, kStoreBytes, colourOf, "map");
  if (stack && image.stackUsed !== null) {
    const used = Math.min(image.stackUsed, stack.bytes);
    whole.append(element("span", {class: "used", title: `stack used: ${format.store(used)}`,
      style: `left:${100 * (kStoreBytes - used) / kStoreBytes}%;width:${100 * used / kStoreBytes}%`}));
  }
  const taken = image.sections.filter((section) => section.name !== "free");
  const total = taken.reduce((sum, section) => sum + section.bytes, 0);
  const resident = taken.filter((section) => section.name !== "stack");
  const end = Math.max(1, ...resident.map((section) => section.begin + section.bytes));

  const table = element("table");
  fillTable(table, ["part", "from", "to", "bytes", "of 256 KiB"], image.sections.map(({name, begin, bytes}) => [
    element("span", {}, swatch(colourOf(name)), name), element("td", {class: "mono"}, format.address(begin)),
    element("td", {class: "mono"}, format.address(begin + bytes - 1)), format.count(bytes), format.percent(bytes / kStoreBytes)]));
  const stackText = !stack ? "" : image.stackUsed === null ? `Stack: ${format.count(stack.bytes)} bytes declared; what is used was not measured.` :
      `Stack: ${format.count(image.stackUsed)} of ${format.count(stack.bytes)} declared bytes were used at most (${format.percent(image.stackUsed / stack.bytes)}), hatched above.`;

  const objects = element("table");
  const largest = [...image.objects].sort((a, b) => b.bytes - a.bytes);
  fillTable(objects, ["variable", "from", "bytes"], largest.map(({name, begin, bytes}) => [
    element("code", {}, name), element("td", {class: "mono"}, format.address(begin)), format.count(bytes)]));

  const parts = [
    element("h3", {}, image.name, image.checked ? " (checked) " : " ", element("span", {class: "total"},
      `${format.store(total)} of 256 KiB taken, budget ${format.store(image.budget)}`)),
    whole, storeAxis(kStoreBytes)];
  if (end < kStoreBytes / 2) {
    parts.push(element("p", {class: "caption"}, `The image itself, its first ${format.store(end)}, enlarged` + (image.objects.length > 0 ? "; below it its variables and buffers:" : ":")),
               storeBar(resident, end, colourOf, "map"));
  }
  if (image.objects.length > 0) {
    const palette = ["bss", "data", "rodata", "text-section"];
    let next = 0;
    parts.push(storeBar(image.objects, end < kStoreBytes / 2 ? end : kStoreBytes, () => colours.of(palette[next++ % palette.length]), "map objects"));
  }
  if (end < kStoreBytes / 2) parts.push(storeAxis(end));
  parts.push(element("div", {class: "columns"},
    element("div", {}, element("div", {class: "scroll"}, table), element("p", {class: "numbers"}, stackText)),
    element("div", {}, image.objects.length === 0 ? "" : element("details", image.objects.length <= 12 ? {open: ""} : {},
      element("summary", {}, plural(image.objects.length, "variable")), element("div", {class: "scroll"}, objects)))));
  return element("article", {class: "store", "aria-label": `Local store of ${image.name}`}, ...parts);
}

function showStores(box, trace) {
  box.replaceChildren(...(trace.images.length > 0 ? trace.images.map(showStore) : [element("p", {}, "No image was loaded.")]));
}
