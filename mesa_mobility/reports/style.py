"""How report pages look, on a screen and on paper of the size A4."""

STYLE = """
:root { --ink: #1d1d1f; --faint: #62666d; --line: #d5d8dc; --blue: #0b4f8a; }
body { font: 15px/1.5 "Helvetica Neue", Arial, "Liberation Sans", sans-serif; color: var(--ink);
  max-width: 58rem; margin: 2rem auto; padding: 0 1.2rem; }
h1 { font-size: 1.75rem; line-height: 1.25; margin: 0 0 0.3rem; }
h2 { font-size: 1.25rem; margin: 2.4rem 0 0.6rem; border-bottom: 2px solid var(--blue); }
h3 { font-size: 1.05rem; margin: 1.5rem 0 0.4rem; }
a { color: var(--blue); text-decoration: none; } a:hover { text-decoration: underline; }
.lead { color: var(--faint); margin: 0 0 1rem; }
nav { background: #f4f6f8; padding: 0.7rem 1.2rem; margin: 1.2rem 0; }
nav ol { list-style: none; margin: 0; padding: 0; } nav ol ol { padding-left: 1.6rem; }
nav > ol > li { margin: 0.1rem 0; } nav b { display: block; margin-bottom: 0.3rem; }
table { border-collapse: collapse; font-size: 0.88rem; width: 100%; margin: 0.5rem 0 0.8rem; }
caption, figcaption { text-align: left; color: var(--ink); font-size: 0.9rem; padding: 0.3rem 0; }
caption b, figcaption b { color: var(--blue); }
th, td { text-align: left; vertical-align: top; padding: 0.25rem 0.8rem 0.25rem 0;
  border-bottom: 1px solid var(--line); overflow-wrap: anywhere; }
th { border-bottom: 2px solid var(--line); } th, td:first-child { overflow-wrap: break-word; }
td:first-child:not(.number) { min-width: 6.5rem; }
td a { white-space: nowrap; }
td.number { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums; }
th.number { text-align: right; }
figure { margin: 0.8rem 0 1.2rem; } img { max-width: 100%; height: auto; display: block; }
.note { color: var(--faint); font-size: 0.88rem; }
pre { background: #f4f6f8; padding: 0.8rem; white-space: pre-wrap; overflow-wrap: anywhere;
  font-size: 0.82rem; }
.pass { color: #176b2c; font-weight: 600; } .fail { color: #b42318; font-weight: 700; }
.notice { border-left: 4px solid #b25e00; background: #fdf4e7; padding: 0.5rem 0.9rem; }
.sign td { height: 2.6rem; vertical-align: bottom; } .sign td:first-child { width: 9rem; }
@page { size: A4; margin: 18mm 16mm 20mm 18mm;
  @bottom-right { content: counter(page) " / " counter(pages); font: 8pt Arial, sans-serif; } }
@media print { body { margin: 0; padding: 0; max-width: none; font-size: 9.5pt; }
  h2, h3 { break-after: avoid; }
  tr, figure, .notice, .sign, .short, caption { break-inside: avoid; }
  thead { display: table-header-group; } caption { break-after: avoid; }
  img { max-height: 110mm; width: auto; } nav, pre { background: none; border: 1px solid #ccc; }
  a { color: inherit; } }
"""
