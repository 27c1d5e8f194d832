// read_mcap.mjs FILE NODE_MODULES: a file of MCAP as Foxglove's own reader sees it, by its index, as JSON: schemas, channels,
// messages in the order of their times, metadata, attachments. Bytes are texts, and numbers of 64 bits too.

import { open } from "node:fs/promises";
import { createRequire } from "node:module";
import { resolve } from "node:path";

const [path, modules] = process.argv.slice(2).map((it) => resolve(it));
const require = createRequire(`${modules}/../read_mcap.mjs`);
const { McapIndexedReader } = require("@mcap/core");
const { decompress } = require("fzstd");

const file = await open(path);
const reader = await McapIndexedReader.Initialize({
  readable: {
    size: async () => BigInt((await file.stat()).size),
    read: async (offset, size) => {
      const bytes = new Uint8Array(Number(size));
      await file.read(bytes, 0, bytes.length, Number(offset));
      return bytes;
    },
  },
  decompressHandlers: { zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size))) },
});

const text = (bytes) => new TextDecoder("utf-8", { fatal: true }).decode(bytes);
const found = { schemas: {}, channels: {}, messages: [], metadata: {}, attachments: {} };
for (const [id, it] of reader.schemasById) found.schemas[id] = [it.name, it.encoding, text(it.data)];
for (const [id, it] of reader.channelsById)
  found.channels[id] = [it.schemaId, it.topic, it.messageEncoding, [...it.metadata]];
for await (const it of reader.readMessages())
  found.messages.push([it.channelId, it.sequence, String(it.logTime), String(it.publishTime), text(it.data)]);
for await (const it of reader.readMetadata()) found.metadata[it.name] = Object.fromEntries(it.metadata);
for await (const it of reader.readAttachments()) found.attachments[it.name] = text(it.data);
await file.close();
process.stdout.write(JSON.stringify(found));
