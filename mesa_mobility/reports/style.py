"""How report pages look, on a screen and on paper of the size A4."""

STYLE = """
:root { --ink: #1d1d1f; --faint: #55595f; --line: #d5d8dc; --blue: #0b4f8a; }
body { font: 15px/1.5 "Helvetica Neue", Arial, "Liberation Sans", sans-serif; color: var(--ink);
  max-width: 58rem; margin: 2rem auto; padding: 0 1.2rem; }
h1 { font-size: 1.85em; line-height: 1.25; margin: 0 0 0.2em; }
h2 { font-size: 1.35em; margin: 1.8em 0 0.5em; border-bottom: 2px solid var(--blue); }
h3 { font-size: 1.12em; margin: 1.4em 0 0.4em; }
a { color: var(--blue); text-decoration: none; } a:hover { text-decoration: underline; }
.lead { color: var(--faint); margin: 0 0 1em; }
nav { background: #f4f6f8; padding: 0.7em 1.2em; margin: 1.2em 0; }
nav ol { list-style: none; margin: 0; padding: 0; } nav ol ol { padding-left: 1.6em; }
nav > ol > li { margin: 0.1em 0; } nav b { display: block; margin-bottom: 0.3em; }
table { border-collapse: collapse; font-size: 0.93em; width: 100%; margin: 0.5em 0 0.8em; }
caption, figcaption { text-align: left; color: var(--ink); padding: 0.3em 0; }
figcaption { font-size: 0.93em; } caption b, figcaption b { color: var(--blue); }
th, td { text-align: left; vertical-align: top; padding: 0.25em 0.9em 0.25em 0;
  border-bottom: 1px solid var(--line); overflow-wrap: break-word; }
th { border-bottom: 2px solid var(--line); vertical-align: bottom; }
td:first-child:not(.number) { min-width: 6.5em; }
td a, .unit, .pass, .fail { white-space: nowrap; }
td.number { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums; }
th.number { text-align: right; }
figure { margin: 0.8em 0 1.2em; } img { max-width: 100%; height: auto; display: block; }
.note { color: var(--faint); font-size: 0.93em; }
.long { overflow-wrap: anywhere; }
pre { background: #f4f6f8; padding: 0.8em; white-space: pre-wrap; overflow-wrap: anywhere;
  font-size: 0.87em; line-height: 1.3; }
pre span { display: inline-block; max-width: 100%; }
.pass { color: #176b2c; font-weight: 600; } .fail { color: #b42318; font-weight: 700; }
.notice { border-left: 4px solid #b25e00; background: #fdf4e7; padding: 0.5em 0.9em; }
.sign td { height: 2.6em; vertical-align: bottom; } .sign td:first-child { width: 9em; }
@page { size: A4; margin: 18mm 16mm 20mm 18mm;
  @bottom-right { content: counter(page) " / " counter(pages); font: 8pt Arial, sans-serif; } }
@media print { body { margin: 0; padding: 0; max-width: none; font-size: 9.5pt; }
  h2, h3 { break-after: avoid; }
  tr, figure, .notice, .note, .sign, .short, caption, pre.command { break-inside: avoid; }
  thead { display: table-header-group; } caption, thead, thead tr { break-after: avoid; }
  p { orphans: 3; widows: 3; }
  tbody tr:first-child:not(:last-child), tbody tr:nth-last-child(2) { break-after: avoid; }
  .note { break-before: avoid; } .lead-in { break-after: avoid; }
  img { max-height: 108mm; width: auto; } nav, pre { background: none; border: 1px solid #ccc; }
  a { color: inherit; } }
"""
