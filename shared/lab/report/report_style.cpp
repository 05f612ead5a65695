#include "lab/report/report_parts.hpp"

namespace tractus::lab::page {

const char* const kStyle = R"css(
:root{--page:#f5f6f8;--card:#ffffff;--ink:#22272e;--soft:#5b6470;--grid:#e6e9ed;--frame:#b9c0c8;
--given:#d9731a;--better:#1b4f8f;--good:#2f7d4f;--warn:#a65b00;--bad:#a92d2a;--wash:#eef2f7;color-scheme:light}
@media (prefers-color-scheme:dark){:root{--page:#14171b;--card:#1c2026;--ink:#e7eaee;--soft:#a3adb8;
--grid:#2b313a;--frame:#454e5a;--given:#f29a52;--better:#74aef0;--good:#6cc48f;--warn:#f0b35c;--bad:#f08a84;
--wash:#242a32;color-scheme:dark}}
@media print{:root{--page:#fff;--card:#fff;--ink:#111;--soft:#444;--grid:#ddd;--frame:#999;--given:#c4620f;
--better:#1b4f8f;--good:#1f6b3f;--warn:#8a4b00;--bad:#8f1f1c;--wash:#f2f2f2;color-scheme:light}}
*{box-sizing:border-box}
body{margin:0;background:var(--page);color:var(--ink);
font:16px/1.5 "Helvetica Neue",Helvetica,Arial,"Liberation Sans","DejaVu Sans",sans-serif}
main{max-width:1020px;margin:0 auto;padding:28px 24px 56px}
header{margin:0 0 18px}
header p,.lead,.note{color:var(--soft);margin:.15em 0 0}
h1{font-size:1.05rem;font-weight:600;margin:0;letter-spacing:.01em}
h2{font-size:1.18rem;margin:0;font-weight:650}
h3{font-size:.98rem;margin:1.3em 0 .3em;font-weight:600}
section{background:var(--card);border:1px solid var(--grid);border-radius:10px;padding:20px 24px 22px;margin:0 0 16px}
.lead{margin:.2em 0 1em;font-size:.92rem}
.note{font-size:.86rem;margin-top:.9em}
.verdict{border-left:6px solid var(--frame);padding:24px 26px 22px}
.verdict.complete,.verdict.missing{border-left-color:var(--good)}
.verdict.partly,.verdict.undecided{border-left-color:var(--warn)}
.verdict.unexplained{border-left-color:var(--bad)}
.verdict h2{font-size:1.75rem;line-height:1.2;letter-spacing:-.01em}
.verdict p{font-size:1.04rem;margin:.5em 0 0;max-width:44em}
.figures{display:flex;flex-wrap:wrap;gap:12px 44px;margin:20px 0 0}
.figures div{min-width:7.5em}
.figures dt{color:var(--soft);font-size:.84rem;margin:0}
.figures dd{margin:.05em 0 0;font-size:1.5rem;font-weight:600;font-variant-numeric:tabular-nums}
.figures small{display:block;font-size:.82rem;font-weight:400;color:var(--soft)}
dl{margin:0}
table{border-collapse:collapse;width:100%;font-size:.92rem;font-variant-numeric:tabular-nums}
th,td{text-align:left;padding:.42em .9em .42em 0;border-bottom:1px solid var(--grid);vertical-align:top}
tr:last-child td{border-bottom:0}
th{color:var(--soft);font-weight:500;font-size:.84rem}
td.n,th.n{text-align:right;white-space:nowrap}
td.n:last-child,th.n:last-child{padding-right:0}
td small{display:block;color:var(--soft);font-size:.84rem}
td.wide{min-width:190px;width:34%;vertical-align:middle}
.bar{position:relative;height:12px;background:var(--wash);border-radius:3px;overflow:hidden;margin:.3em 0}
.bar i{position:absolute;inset:0 auto 0 0;border-radius:3px;background:var(--better)}
.bar.given i{background:var(--given)}.bar.quiet i{background:var(--frame)}
.steps{display:grid;grid-template-columns:minmax(8em,auto) 1fr;gap:12px 18px;align-items:center;position:relative}
.steps .track{position:relative;padding-right:5.2em}
.steps .line{position:relative;height:17px;margin:2px 0}
.steps .line i{position:absolute;inset:0 auto 0 0;border-radius:0 3px 3px 0;background:var(--better)}
.steps .line.held i{background:none;border:1.5px solid var(--better);opacity:.85}
.steps .first .line i{background:var(--given)}.steps .first .line.held i{background:none;border-color:var(--given)}
.steps .line b{position:absolute;right:-5.2em;top:-3px;font-weight:500;font-size:.88rem;width:4.8em;text-align:right;font-variant-numeric:tabular-nums}
.steps .floor{position:absolute;top:-6px;bottom:-6px;border-left:2px dashed var(--soft);z-index:1}
.key{display:flex;flex-wrap:wrap;gap:4px 22px;font-size:.86rem;color:var(--soft);margin:1em 0 0}
.key i{display:inline-block;width:20px;height:10px;border-radius:2px;margin-right:7px;background:var(--soft)}
.key .held{background:none;border:1.5px solid var(--soft)}
.key .dash{height:0;border-top:2px dashed var(--soft);background:none;vertical-align:middle}
.ask{border-left:4px solid var(--better);background:var(--wash);padding:12px 16px;border-radius:4px;margin:.9em 0 0}
.ask b{display:block}
details summary{cursor:pointer;color:var(--soft);font-size:.9rem;margin:.9em 0 .4em}
code{font-family:"DejaVu Sans Mono",Consolas,monospace;font-size:.86em}
ul{margin:.2em 0 0;padding-left:1.2em}li{margin:.25em 0}
footer{color:var(--soft);font-size:.84rem;margin:22px 4px 0}
svg{display:block;width:100%;height:auto;margin:6px 0 4px}
svg rect[fill="#ffffff"]{fill:var(--card)}
svg text[fill="#22272e"]{fill:var(--ink)}
svg text[fill="#5b6470"]{fill:var(--soft)}
svg [stroke="#e6e9ed"]{stroke:var(--grid)}
svg [stroke="#b9c0c8"]{stroke:var(--frame)}
svg [stroke="#5b6470"]{stroke:var(--soft)}
svg [stroke="#ffffff"]{stroke:var(--card)}
svg [stroke="#22272e"]{stroke:var(--ink)}svg [fill="#22272e"]{fill:var(--ink)}
svg [stroke="#d9731a"]{stroke:var(--given)}svg [fill="#d9731a"]{fill:var(--given)}
svg [stroke="#1b4f8f"]{stroke:var(--better)}svg [fill="#1b4f8f"]{fill:var(--better)}
@media (max-width:900px){td:first-child{min-width:8.5em}td.wide{min-width:90px;width:20%}td.n{white-space:normal}}
@media (max-width:700px){main{padding:16px 12px 40px}section{padding:16px}.verdict h2{font-size:1.4rem}}
@media print{body{font-size:12px}main{max-width:none;padding:0}section{border-color:#ccc}svg,tr,.ask,.verdict,.steps{break-inside:avoid}h2,h3{break-after:avoid}
td:first-child{min-width:8.5em}td.wide{min-width:90px;width:20%}
details:not([open])>*{display:block}.bar,.bar i,.steps i,.key i{-webkit-print-color-adjust:exact;print-color-adjust:exact}}
)css";

}  // namespace tractus::lab::page
