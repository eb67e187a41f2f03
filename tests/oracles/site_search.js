// The search of a built site as its page does it: node site_search.js SITE < words, one query a line.
"use strict";
const fs = require("fs"), path = require("path"), vm = require("vm");
const nothing = { getElementById: () => null, querySelectorAll: () => [], setItem() {} };
const page = { document: nothing, localStorage: nothing, Documentation: nothing, console, SPHINX_HIGHLIGHT_ENABLED: false };
Object.assign(page, { window: page, _: (text) => text, _ready() {} });
vm.createContext(page);
for (const file of ["_static/searchtools.js", "_static/language_data.js", "searchindex.js"])
  vm.runInContext(fs.readFileSync(path.join(process.argv[2], file), "utf8"), page, { timeout: 10000 });
vm.runInContext("var results = (query) => Search._performSearch(...Search._parseQuery(query)).reverse()", page);
const queries = fs.readFileSync(0, "utf8").split("\n").filter(Boolean);
console.log(JSON.stringify(Object.fromEntries(queries.map((q) => [q, page.results(q).map((found) => found[0])]))));
