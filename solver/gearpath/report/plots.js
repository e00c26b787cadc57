// Draws every figure of the page from the data block; equal abscissae are stored once, by number.
(function () {
  "use strict";
  var book = JSON.parse(document.getElementById("figure-data").textContent);
  var touch = window.matchMedia("(pointer: coarse)").matches;
  var config = { responsive: true, displaylogo: false, modeBarButtons: [["zoom2d", "pan2d", "resetScale2d", "toImage"]] };
  var drawn = [];

  function draw(box) {
    var figure = book.figures[box.id];
    if (!figure || box.dataset.drawn) { return; }
    figure.data.forEach(function (trace) { if ("x" in trace) { trace.x = book.grids[trace.x]; } });
    var narrow = box.clientWidth < 560; // no room for buttons beside the curves
    if (touch) { figure.layout.dragmode = false; } // a finger scrolls the page
    if (narrow) {
      figure.layout.font.size = 10;
      figure.layout.margin.l = 44;
      figure.layout.margin.r = 16;
    }
    box.dataset.drawn = "yes";
    box.textContent = "";
    Plotly.newPlot(box, figure.data, figure.layout, narrow ? Object.assign({}, config, { displayModeBar: false }) : config);
    drawn.push(box);
  }

  document.querySelectorAll(".plot").forEach(function (box) {
    var folded = box.closest("details:not([open])");
    if (!folded) { draw(box); return; }
    folded.addEventListener("toggle", function () { if (folded.open) { draw(box); } });
  });

  window.addEventListener("beforeprint", function () {
    document.querySelectorAll("details.print").forEach(function (fold) { fold.open = true; });
    document.querySelectorAll(".plot").forEach(draw);
    drawn.forEach(function (box) { Plotly.relayout(box, { autosize: false, width: 680 }); });
  });
  window.addEventListener("afterprint", function () {
    drawn.forEach(function (box) { Plotly.relayout(box, { autosize: true, width: null }); });
  });
})();
