#include "report/page_parts.h"

namespace sphgeo {

// Two sets of colours, chosen by what the reader's system prefers. Numbers stand in columns of
// equal digits.
const std::string_view page_style = R"css(:root {
  color-scheme: light dark;
  --page: #ffffff; --ink: #1d2229; --quiet: #646c78; --rule: #e1e4e9; --panel: #f6f7f9;
      --accent: #22608f;
  --good: #1d7a48; --good-back: #e5f4ea; --bad: #b3261e; --bad-back: #fbe9e7; --warn: #8a5a00;
      --warn-back: #fdf3dc;
  --curve-0: #2b74b8; --curve-1: #cf5b22; --curve-2: #2f9463; --curve-3: #8d64b5;
  --curve-4: #a98612; --curve-5: #c44d86; --curve-6: #2499a6; --curve-7: #7d7f86;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #15181c; --ink: #e3e6ea; --quiet: #99a2ae; --rule: #2d333b; --panel: #1d2126;
        --accent: #7db8e8;
    --good: #6fcf97; --good-back: #17301f; --bad: #f2988f; --bad-back: #3a1c1a; --warn: #e5bd6a;
        --warn-back: #332812;
    --curve-0: #5fa8e6; --curve-1: #f08a52; --curve-2: #5cc490; --curve-3: #b793dd;
    --curve-4: #d2b04a; --curve-5: #e67fb0; --curve-6: #57c4cf; --curve-7: #a4a8b0;
  }
}
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; text-size-adjust: 100%; }
body { margin: 0; background: var(--page); color: var(--ink);
    font: 15px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", sans-serif; }
main { max-width: 1180px; margin: 0 auto; padding: 28px 20px 60px; }
h1 { font-size: 1.65rem; line-height: 1.25; font-weight: 650; margin: 0 0 6px;
    overflow-wrap: anywhere; }
h2 { font-size: 1.12rem; font-weight: 650; margin: 40px 0 12px; padding-top: 14px;
    border-top: 1px solid var(--rule); }
h3 { font-size: .95rem; font-weight: 600; margin: 22px 0 8px; }
p { margin: 6px 0; max-width: 75ch; }
.quiet, small { color: var(--quiet); }
small { font-size: .85em; }
.status { display: flex; flex-wrap: wrap; align-items: baseline; gap: 4px 12px; margin: 8px 0; }
.badge { display: inline-block; padding: 1px 10px; border-radius: 4px; font-weight: 600;
    font-size: .86rem; white-space: nowrap; }
.good { color: var(--good); } .badge.good { background: var(--good-back); }
.bad { color: var(--bad); } .badge.bad { background: var(--bad-back); }
.warn { color: var(--warn); } .badge.warn { background: var(--warn-back); }
.message { border-left: 3px solid var(--bad); background: var(--bad-back); padding: 8px 14px;
    margin: 12px 0; overflow-wrap: anywhere; }
.message.warn { color: inherit; border-color: var(--warn); background: var(--warn-back); }
.message p { max-width: none; }
.facts { display: grid; grid-template-columns: repeat(auto-fit, minmax(132px, 1fr));
    gap: 14px 22px; margin: 0; }
.facts div { min-width: 0; }
.facts dt { color: var(--quiet); font-size: .82rem; }
.facts dd { margin: 0; font-size: 1.16rem; font-variant-numeric: tabular-nums;
    overflow-wrap: anywhere; }
.facts dd small { display: block; font-size: .78rem; line-height: 1.35; }
.box { overflow-x: auto; -webkit-overflow-scrolling: touch; }
table { border-collapse: collapse; width: 100%; font-size: .9rem;
    font-variant-numeric: tabular-nums; }
table.slim { width: auto; min-width: min(100%, 460px); }
th, td { padding: 5px 14px 5px 0; text-align: left; vertical-align: baseline;
    border-bottom: 1px solid var(--rule); }
th:last-child, td:last-child { padding-right: 0; }
th { font-weight: 600; font-size: .82rem; color: var(--quiet); white-space: nowrap;
    border-bottom-color: color-mix(in srgb, var(--ink) 35%, transparent); }
td.n, th.n { text-align: right; white-space: nowrap; }
td.wide { min-width: 15em; }
td small { display: block; line-height: 1.4; }
th.run { border-left: 1px solid var(--rule); padding-left: 14px; }
td.run { border-left: 1px solid var(--rule); padding-left: 14px; }
.bar { display: inline-block; height: .55em; min-width: 1px; background: var(--accent);
    opacity: .75; }
td.bar-cell { width: 30%; min-width: 90px; }
.charts { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 370px), 1fr));
    gap: 26px 34px; }
.charts figure { max-width: 600px; }
figure { margin: 0; min-width: 0; }
figcaption { font-size: .84rem; color: var(--quiet); }
.quantity { display: flex; flex-wrap: wrap; align-items: end; justify-content: space-between;
    gap: 2px 30px; margin: 26px 0 8px; }
.quantity h3 { margin: 0; }
.quantity svg { width: 360px; max-width: 100%; height: auto; display: block; }
.shots { display: grid; grid-template-columns: repeat(3, minmax(0, 1fr)); gap: 10px 12px; }
.shots.rows { grid-template-columns: repeat(var(--columns), minmax(0, 1fr)); }
.shot { background: var(--panel); border-radius: 4px; padding: 4px; }
.shot img { display: block; width: 100%; height: auto; }
.shot figcaption { padding: 0 4px; font-variant-numeric: tabular-nums; }
.column-title { font-weight: 600; font-size: .86rem; overflow-wrap: anywhere; }
details > summary { cursor: pointer; color: var(--accent); padding: 4px 0; }
pre { background: var(--panel); border-radius: 4px; padding: 12px 14px; overflow: auto;
    max-height: 70vh; font: 12.5px/1.5 ui-monospace, "SF Mono", Menlo, Consolas, monospace;
    tab-size: 2; }
code { font: .88em ui-monospace, "SF Mono", Menlo, Consolas, monospace; }
@media (max-width: 640px) {
  main { padding: 18px 16px 40px; }
  h1 { font-size: 1.35rem; }
  h2 { margin-top: 30px; }
  .shots { grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 8px; }
  .facts { grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 12px 16px; }
  td.wide { min-width: 12em; }
}
@media print {
  main { max-width: none; padding: 0; }
  pre { max-height: none; white-space: pre-wrap; }
  figure, tr { break-inside: avoid; }
}
)css";

}  // namespace sphgeo
