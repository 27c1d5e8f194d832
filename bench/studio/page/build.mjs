// node build.mjs FOLDER: the page as studio.js, studio.css, studio.html and icon.svg, for embed.cmake.
import { build } from "esbuild";
import { copyFile, mkdir } from "node:fs/promises";

const folder = process.argv[2];
if (!folder) throw new Error("give the folder to write to");
await mkdir(folder, { recursive: true });
await build({
  entryPoints: { studio: "src/main.ts" },
  bundle: true,
  minify: true,
  format: "iife",
  target: ["es2021", "chrome100", "firefox100", "safari15.4"],
  outdir: folder,
  preserveSymlinks: true,
  legalComments: "eof",
  logLevel: "warning",
});
for (const name of ["studio.html", "icon.svg"]) await copyFile(`src/${name}`, `${folder}/${name}`);
