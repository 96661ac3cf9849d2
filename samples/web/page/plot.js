// plot.js  The last steps: their time and the budget as lines, the figures' tiers as bars.

const kFrames = 240;
const kTiers = ['network', 'modal', 'extrapolated', 'skinned', 'hidden'];
const kBars = 0.4;  // of the height

export class Plot {
  constructor(canvas) {
    this.canvas = canvas;
    this.frames = [];
    this.shown_us = 4000;
  }

  add(report) {
    this.frames.push(report);
    if (this.frames.length > kFrames) this.frames.shift();
  }

  clear() { this.frames = []; }

  // budget_us: infinite: none.
  draw(budget_us) {
    const {canvas, frames} = this, scale = Math.min(2, devicePixelRatio), width = canvas.clientWidth, height = canvas.clientHeight;
    if (!width || !frames.length) return;
    if (canvas.width !== Math.round(width * scale)) canvas.width = Math.round(width * scale), canvas.height = Math.round(height * scale);
    const pen = canvas.getContext('2d'), style = getComputedStyle(document.documentElement);
    const color = (name) => style.getPropertyValue(`--${name}`).trim();
    pen.setTransform(scale, 0, 0, scale, 0, 0);
    pen.clearRect(0, 0, width, height);
    const step = width / kFrames, bars = kBars * height, graph = height - bars - 6;
    frames.forEach((report, i) => {
      const all = kTiers.reduce((sum, tier) => sum + report[tier], 0);
      let y = height;
      for (const tier of kTiers) {
        const part = (bars * report[tier]) / all;
        pen.fillStyle = color(tier);
        pen.fillRect(i * step, y - part, step + 0.5, part);
        y -= part;
      }
    });
    const times = frames.map(({stepUs}) => stepUs).sort((a, b) => a - b), high = times[Math.floor(0.98 * (times.length - 1))];
    const wanted = 1.25 * Math.max(high, Number.isFinite(budget_us) ? budget_us : 0, 100);
    this.shown_us = wanted > this.shown_us || wanted < 0.5 * this.shown_us ? wanted : this.shown_us;
    const at = (us) => graph * (1 - Math.min(1, us / this.shown_us)) + 1;
    pen.strokeStyle = color('ink');
    pen.beginPath();
    frames.forEach(({stepUs}, i) => pen.lineTo((i + 0.5) * step, at(stepUs)));
    pen.stroke();
    pen.font = '11px system-ui, sans-serif';
    pen.fillStyle = color('quiet');
    pen.fillText(`${(this.shown_us / 1000).toFixed(1)} ms a step`, 2, 11);
    if (!Number.isFinite(budget_us)) return;
    pen.strokeStyle = pen.fillStyle = color('accent');
    pen.setLineDash([4, 3]);
    pen.beginPath();
    pen.moveTo(0, at(budget_us)), pen.lineTo(width, at(budget_us));
    pen.stroke();
    pen.setLineDash([]);
    pen.fillText('budget', width - 40, at(budget_us) - 3);
  }
}
