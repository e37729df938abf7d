(function () {
  'use strict';
  // Neither the sign of "less" nor that of "and" stands in this file: the page is XML as well.
  const button = document.getElementById('show-model'), place = document.getElementById('blockrand-view');
  if (!('DecompressionStream' in window)) return;
  button.hidden = false;
  const text = async function (base64) {
    const binary = atob(base64), bytes = Uint8Array.from(binary, function (c) { return c.charCodeAt(0); });
    return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'))).text();
  };
  button.addEventListener('click', async function () {
    button.disabled = true;
    try {
      const files = JSON.parse(document.getElementById('viewer-files').textContent);
      const style = document.createElement('style');
      style.textContent = await text(files['viewer.css']);
      const script = document.createElement('script');
      script.src = URL.createObjectURL(new Blob([await text(files['viewer.js'])], { type: 'text/javascript' }));
      document.head.append(style);
      await new Promise(function (done, failed) {
        script.onload = done;
        script.onerror = function () { failed(new Error('the browser runs no script from this page')); };
        document.head.append(script);
      });
      button.remove();
      place.hidden = false;
      await window.BlockrandView.start(place);
    } catch (error) {
      document.getElementById('model-text').textContent = 'The model cannot be shown: ' + error.message;
    }
  });
})();
