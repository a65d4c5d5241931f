#include "lab/report_style.hpp"

#include "lab/plot.hpp"

#include <cstddef>

namespace lab {
namespace {

constexpr const char* style = R"(
:root { color-scheme: light dark; --paper: #fbfaf7; --ink: #1f2328; --soft: #5d6670; --rule: #d9d6cf;
  --card: #ffffff; --c0: #7b8794; --c1: #2f7dc0; --c2: #c4532d; --c3: #9a6cc0; --c4: #3f8f4f;
  --c5: #b88a00; --c6: #c2417c; --c7: #2a9d9d; --c8: #5b6bd6; --c9: #8a6d3b;
  --c10: #6a994e; --c11: #a23b3b; }
@media (prefers-color-scheme: dark) { :root { --paper: #16181b; --ink: #e6e4df; --soft: #9aa3ad;
  --rule: #33383e; --card: #1d2024; --c0: #9aa7b4; --c1: #63aeea; --c2: #f0845c; --c3: #bf9be0;
  --c4: #6fc283; --c5: #e0b84a; --c6: #ec7fb0; --c7: #5fcaca;
  --c8: #98a4ff; --c9: #c7a66b; --c10: #a3cf86; --c11: #e08080; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, -apple-system, "Segoe UI", sans-serif; }
main { max-width: 1240px; margin: 0 auto; padding: 1.2rem; }
h1 { font-size: 1.6rem; margin: .4rem 0; }
h2 { margin: 2.4rem 0 .2rem; font-size: 1.3rem; overflow-wrap: anywhere; scroll-margin: .6rem; }
a { color: inherit; }
.contents { columns: 15rem; padding: 0 0 0 1.1rem; } .contents li { padding: .15rem 0; }
h3 { margin: 0; font-size: 1.05rem; } h3 small, p, figcaption { color: var(--soft); }
p { margin: .3rem 0; overflow-wrap: anywhere; } .passes { font-size: .8rem; }
.scroll { overflow-x: auto; margin: 1rem 0; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: .9rem; }
th, td { text-align: left; padding: .3rem .8rem .3rem 0; border-bottom: 1px solid var(--rule);
  white-space: nowrap; }
th { font-weight: 600; vertical-align: bottom; white-space: normal; } .n { text-align: right; }
.runs .view { padding-top: 1.1rem; white-space: nowrap; }
.runs tr > :first-child { position: sticky; left: 0; background: var(--paper); }
.cards { display: grid; gap: 1.2rem; grid-template-columns: repeat(auto-fill, minmax(min(100%, 380px), 1fr)); }
article { background: var(--card); border: 1px solid var(--rule); border-radius: 8px; padding: .8rem; }
img { width: 100%; height: auto; display: block; border-radius: 3px; margin-top: .4rem; }
.pixel { image-rendering: pixelated; }
.pair { display: grid; grid-template-columns: 1fr 1fr; gap: .4rem; }
.matrix { display: grid; gap: .6rem; margin: .4rem 0 1.2rem;
  grid-template-columns: repeat(auto-fill, minmax(min(100%, var(--cell)), 1fr)); }
.reference { max-width: 512px; margin: .6rem 0 1.2rem; }
figure { margin: 0; } figcaption { font-size: .8rem; } summary { cursor: pointer; margin-top: .5rem; }
.plot { display: block; width: 100%; min-width: 564px; max-width: 640px; height: auto;
  font-size: 13px; }
.plot text { fill: var(--ink); stroke: var(--paper); stroke-width: 3px; stroke-linejoin: round;
  paint-order: stroke; }
.plot .small { font-size: 12.6px; fill: var(--soft); } .lead { stroke: var(--soft); stroke-width: .7; }
.grid { stroke: var(--rule); stroke-width: .6; } .axis { stroke: var(--soft); }
.series { stroke-width: 1.6; } .span { stroke-width: 1.2; }
.plots { display: grid; gap: 0 1rem;
  grid-template-columns: repeat(auto-fill, minmax(min(100%, 564px), 1fr)); }
.plots .scroll { margin: .5rem 0; }
.plot .open { fill: none; }
.front { fill: none; stroke: var(--ink); stroke-width: 5; stroke-opacity: .18; stroke-linejoin: round; }
.answer td { white-space: normal; } .answer small { color: var(--soft); }
.over { position: relative; max-width: 1024px; cursor: ew-resize; touch-action: pan-y;
  user-select: none; --border: 50%; }
.over img { margin: 0; }
.over img + img { position: absolute; inset: 0; clip-path: inset(0 0 0 var(--border)); }
.over::after { content: ""; position: absolute; top: 0; bottom: 0; left: var(--border); width: 2px;
  margin-left: -1px; background: #fff; box-shadow: 0 0 3px #000; pointer-events: none; }
@media (min-width: 1024px) { .over img { image-rendering: pixelated; } }
.compare { margin: .8rem 0 1.2rem; } .compare input { width: 100%; max-width: 1024px; }
select { font: inherit; max-width: 100%; }
.dot { display: inline-block; width: .7em; height: .7em; border-radius: 50%; margin-right: .45em; }
)";

constexpr const char* script = R"(
for (const box of document.querySelectorAll(".compare")) {
  const [left, right] = box.querySelectorAll("select"), [under, over] = box.querySelectorAll("img");
  const truth = box.parentElement.querySelector(".truth"), slider = box.querySelector("input");
  const both = box.querySelector(".over");
  const source = choice => (choice.value ? document.getElementById(choice.value) : truth).src;
  const choose = () => { under.src = source(left); over.src = source(right); };
  const move = () => both.style.setProperty("--border", slider.value + "%");
  const drag = event => {
    if (event.buttons & 1) {
      const place = both.getBoundingClientRect();
      slider.value = 100 * (event.clientX - place.left) / place.width;
      move();
    }
  };
  right.selectedIndex = Math.min(1, right.options.length - 1);
  for (const each of [left, right]) each.addEventListener("change", choose);
  slider.addEventListener("input", move);
  both.addEventListener("pointermove", drag);
  both.addEventListener("pointerdown", event => {
    both.setPointerCapture(event.pointerId);
    drag(event);
  });
  choose();
}
)";

std::string colour_rules() {
    std::string css;
    for (std::size_t i = 0; i < plot_colours; ++i) {
        const std::string name = std::string("c") + std::to_string(i);
        const std::string colour = std::string("var(--") + name + ")";
        css += '.';
        css += name + " { stroke: " + colour + "; fill: " + colour + "; }\n";
        css += "i.";
        css += name + " { background: " + colour + "; }\n.plot text.";
        css += name + " { stroke: var(--paper); fill: " + colour + "; font-weight: 600; }\n";
    }
    return css;
}

} // namespace

std::string report_style() {
    return std::string(style) + colour_rules();
}

std::string_view report_script() {
    return script;
}

} // namespace lab
