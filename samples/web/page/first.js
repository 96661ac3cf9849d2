// first.js  Whether this browser can run the page. A plain script, so that old browsers run it, too.
(function () {
  function hasSimd() {
    // A function that splats a number over a vector.
    var module = [0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11];
    return typeof WebAssembly === 'object' && WebAssembly.validate(new Uint8Array(module));
  }
  function lacks() {
    if (!('noModule' in HTMLScriptElement.prototype)) return 'This browser is too old to run Sinew. Any of the last three years can.';
    if (!hasSimd()) return 'This browser has no WebAssembly SIMD, which Sinew computes with. Chrome 91, Firefox 89 and Safari 16.4 have it.';
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
