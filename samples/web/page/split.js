// split.js  The line between skinning and Sinew.

export class Split {
  constructor(settings) {
    const line = document.getElementById('split');
    this.line = line;
    const move = (share) => settings.set('split', Math.min(1, Math.max(0, share)));
    let off_px = 0;  // of the pointer from the line
    line.addEventListener('pointerdown', (event) => {
      const {left, width} = line.getBoundingClientRect();
      off_px = event.clientX - left - width / 2;
      line.setPointerCapture(event.pointerId);
      event.preventDefault();
      line.focus();
    });
    line.addEventListener('pointermove', (event) => {
      if (!line.hasPointerCapture(event.pointerId)) return;
      const {left, width} = line.parentElement.getBoundingClientRect();
      move((event.clientX - off_px - left) / width);
    });
    line.addEventListener('keydown', (event) => {
      const by = {ArrowLeft: -0.02, ArrowRight: 0.02, Home: -1, End: 1}[event.key];
      if (by === undefined) return;
      event.preventDefault();
      move(settings.get('split') + by);
    });
    settings.listen((name) => name === 'split' && this.show(settings.get('split')));
    this.show(settings.get('split'));
  }

  show(share) {
    this.line.style.left = `${100 * share}%`;
    this.line.setAttribute('aria-valuenow', Math.round(100 * share));
    this.line.querySelector('.left').style.visibility = share > 0.12 ? 'visible' : 'hidden';
    this.line.querySelector('.right').style.visibility = share < 0.9 ? 'visible' : 'hidden';
  }
}
