// serve.mjs  node serve.mjs FOLDER [PORT]: serves a folder on loopback and prints the address. Any file server does as well; isolated as here,
// browsers give the page a clock of microseconds, which budgets are kept better by.
import fs from 'node:fs';
import http from 'node:http';
import path from 'node:path';
import {fileURLToPath} from 'node:url';

const kTypes = {'.html': 'text/html; charset=utf-8', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm', '.txt': 'text/plain; charset=utf-8'};

export function serve(folder, port = 0) {
  const root = path.resolve(folder);
  const answer = (request, response) => {
    const name = path.normalize(decodeURIComponent(new URL(request.url, 'http://localhost').pathname));
    const file = path.join(root, name.endsWith('/') ? `${name}index.html` : name);
    fs.readFile(file, (error, bytes) => {
      if (error || !file.startsWith(root)) return response.writeHead(404).end();
      response.writeHead(200, {
        'Content-Type': kTypes[path.extname(file)] ?? 'application/octet-stream', 'Cache-Control': 'no-cache',
        'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp',
      }).end(bytes);
    });
  };
  const server = http.createServer((request, response) => {
    try {
      answer(request, response);
    } catch {
      response.writeHead(400).end();
    }
  });
  return new Promise((resolve, reject) => {
    server.once('error', reject);
    server.listen(port, '127.0.0.1', () => resolve({server, address: `http://127.0.0.1:${server.address().port}/`}));
  });
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const [folder, port] = process.argv.slice(2);
  if (!folder || !fs.existsSync(path.join(folder, 'index.html'))) {
    console.error('usage: node serve.mjs FOLDER [PORT]; the folder holds an index.html');
    process.exit(2);
  }
  // Another port where that one is taken.
  serve(folder, Number(port ?? 0)).catch(() => serve(folder)).then(({address}) => console.log(`Open ${address}`), (error) => {
    console.error(`serve.mjs: ${error.message}`);
    process.exit(2);
  });
}
