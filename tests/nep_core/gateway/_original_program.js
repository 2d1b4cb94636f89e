// A program that uses nep-js as its users do; the test says which topics.
"use strict"
const nep = require("nep-js")

const [name, told] = process.argv.slice(2)
const node = new nep.Node(name)

for (const { topic, kind, style, says } of JSON.parse(told)) {
  if (says !== undefined) {
    const publisher = style === 5 ? node.new_pub(topic, kind) : node.new_publisher(topic, kind)
    setInterval(() => publisher.publish(says), 30)
  } else {
    const hear = heard => console.log("\n@" + JSON.stringify({ topic, heard }))
    style === 5 ? node.new_sub(topic, kind, hear) : node.new_callback(topic, kind, hear)
  }
}
process.stdin.on("end", () => process.exit(0)).resume()
