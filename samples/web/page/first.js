// first.js  Whether this browser can run the page. A plain script, so that old browsers run it, too.
(function () {
  function hasSimd() {
    // A function that splats a number over a vector.
    var module = [0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11];
    return typeof WebAssembly === 'object' && WebAssembly.validate(new Uint8Array(module));
  }
  function lacks() {
    if (location.protocol === 'file:') return 'A browser reads this page from a file server alone: samples/web/run.sh starts one, and any other does as well.';
    if (!(HTMLScriptElement.supports && HTMLScriptElement.supports('importmap'))) return 'This browser is too old to run Sinew: Chrome 96, Firefox 108 and Safari 16.4 can.';
    if (!hasSimd()) return 'This browser has no WebAssembly SIMD, which Sinew computes with. Chrome, Firefox and Safari have it since 2023.';
    return '';
  }
  window.sinewLacks = lacks();
  window.sinewSayLack = function (text) {
    var sentence = document.createElement('p');
    sentence.className = 'cannot';
    sentence.textContent = text;
    document.body.appendChild(sentence);
  };
  if (window.sinewLacks) document.addEventListener('DOMContentLoaded', function () { window.sinewSayLack(window.sinewLacks); });
})();
