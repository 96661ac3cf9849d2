// files.js  Files of one's own: dropped on the page, or chosen.

const kPack = /\.sinew$/i, kLook = /\.(glb|vrm)$/i;

// What a list of files asks for: {pack, look}, of which one may be missing; throws a sentence.
export function sortFiles(files, hasOwnPack) {
  const pack = files.find(({name}) => kPack.test(name)), look = files.find(({name}) => kLook.test(name));
  if (!pack && !look) {
    const name = files[0]?.name ?? 'that';
    const isText = /\.gltf$/i.test(name);
    throw new Error(`${name} cannot be shown: drop a .sinew, with the .glb or .vrm that it was baked from${isText ? '. A .gltf is exported as .glb, in one file' : ''}.`);
  }
  if (!pack && !hasOwnPack)
    throw new Error(`${look.name} needs its motion: bake it, "sinew-bake character ${look.name} -o ${look.name.replace(kLook, '.sinew')}", and drop both files together.`);
  return {pack, look};
}

// take(files): called with each list.
export function listenForFiles(take) {
  const over = document.getElementById('over'), input = document.getElementById('files');
  let inside = 0;
  const hasFiles = (event) => [...(event.dataTransfer?.types ?? [])].includes('Files');
  addEventListener('dragenter', (event) => { if (hasFiles(event)) over.hidden = ++inside < 1; });
  addEventListener('dragleave', (event) => { if (hasFiles(event)) over.hidden = --inside < 1; });
  addEventListener('dragover', (event) => event.preventDefault());
  addEventListener('drop', (event) => {
    event.preventDefault();
    inside = 0, over.hidden = true;
    if (event.dataTransfer.files.length) take([...event.dataTransfer.files]);
  });
  input.addEventListener('change', () => {
    if (input.files.length) take([...input.files]);
    input.value = '';
  });
}
