// NEP for JavaScript: a node that joins the master, talks, tells how it is doing, and stops when
// asked. docs/wire.md describes what goes over the wire, in the words that are used here.
import { randomUUID } from 'node:crypto'
import { writeFileSync } from 'node:fs'
import { hostname } from 'node:os'
import { setTimeout as sleep } from 'node:timers/promises'
import { Dealer, Subscriber, XPublisher } from 'zeromq'

const HEARTBEAT_MS = 500 // to the master, which forgets us after 3 s
const ALIVE_MS = 1000 // to everybody
const LAST_WORDS_MS = 3000 // of a publisher that has left, or that a new master does not know yet
const HIGH_WATER_MARK = 4000 // frames that wait for one that is slow
const PRIVATE = Buffer.from([0xff, 0x73]) // how private topics begin, and no text does

// What a person can act on: a sentence, and steps to try.
export class NepError extends Error {
  constructor(sentence, checklist = []) {
    super(sentence)
    this.checklist = checklist
  }
}

const beginsWith = (bytes, start) => bytes.subarray(0, start.length).equals(start)
const privateTopic = (topic, id) => Buffer.concat([PRIVATE, Buffer.from(`${topic}\0${id}\0`)])

// Milliseconds are too coarse, and a JavaScript number is too small for nanoseconds since 1970.
const nanoseconds = () =>
  BigInt(Math.round((performance.timeOrigin + performance.now()) * 1000)) * 1000n

// Where to connect: over p2p to the master alone, and to each publisher where it is; else to a
// broker, which passes everything on, and has a master two ports further.
function places() {
  const { NEP_NETWORK, NEP_KEYS, NEP_MASTER, NEP_BROKER } = process.env
  const network = NEP_NETWORK || 'p2p'
  if (!['p2p', 'broker'].includes(network) || NEP_KEYS) {
    throw new NepError(
      'This node can join only a p2p or broker network that is not open to others.',
      ['Start it without NEP_NETWORK and NEP_KEYS.', 'Or use a node in Python.']
    )
  }
  if (network === 'p2p') return { master: NEP_MASTER || 'tcp://127.0.0.1:7100' }
  const broker = NEP_BROKER || 'tcp://127.0.0.1:7110'
  const further = (ports) => broker.replace(/\d+$/, (port) => Number(port) + ports)
  return { master: further(2), toPublish: broker, toHear: further(1) }
}

// zeromq.js refuses to send while it is sending: one after the other.
function inOrder(socket) {
  let last = Promise.resolve()
  return (frame) => (last = last.then(() => socket.send(frame)))
}

class Publisher {
  seen = new Set() // the ids of those that hear us now
  #sent = 0
  #keptNumber = 0
  #kept = '' // what subscribers of a latched topic get that come later

  constructor(node, run, topic, isLatched, send) {
    Object.assign(this, { node, run, topic, isLatched, sendFrame: send })
  }

  // Sends anything that JSON can say; `latch: false` keeps what late subscribers get.
  send(message, { latch = true } = {}) {
    const payload = JSON.stringify(message)
    const frame = `${this.#start(++this.#sent)}]\0${payload}`
    if (this.isLatched && latch) [this.#keptNumber, this.#kept] = [this.#sent, `\0${payload}`]
    return this.sendFrame(Buffer.from(frame))
  }

  // What a newcomer is told: how many messages there were, and the last one of a latched topic.
  notice() {
    return `${this.#start(this.#keptNumber || this.#sent)},${this.#sent}]${this.#kept}`
  }

  #start(number) {
    const [node, run] = [JSON.stringify(this.node), JSON.stringify(this.run)]
    return `${this.topic}\0[${node},${number},${nanoseconds()},"json",${run}`
  }
}

class Subscription {
  id = randomUUID()
  lost = 0
  welcomed = new Set() // the instances of the publishers that know that we hear them
  #endpoints = new Set()
  #leaving = new Map()
  #numbers = new Map() // by publisher: the first that came, and the last that was sent
  #socket = new Subscriber({ receiveHighWaterMark: HIGH_WATER_MARK, linger: 0 })

  constructor(topic, callback, broker) {
    Object.assign(this, { topic, callback, broker, private: privateTopic(topic, this.id) })
    this.#socket.subscribe(`${topic}\0`)
    this.#socket.subscribe(this.private) // after the data: the proof rests on it
    if (broker) this.#socket.connect(broker)
    this.ended = this.#hear()
  }

  // Hears exactly these publishers from now on.
  connect(publishers) {
    if (this.broker) return // they are all behind it
    const wanted = new Set(publishers.map((publisher) => publisher.endpoint))
    for (const endpoint of this.#endpoints) {
      if (!wanted.has(endpoint)) this.#leaving.set(endpoint, performance.now())
    }
    for (const endpoint of wanted) {
      const isNew = !this.#endpoints.has(endpoint) && !this.#leaving.delete(endpoint)
      if (isNew) this.#socket.connect(endpoint)
    }
    this.#endpoints = wanted
  }

  tend() {
    for (const [endpoint, sinceMs] of this.#leaving) {
      if (performance.now() - sinceMs < LAST_WORDS_MS) continue
      this.#leaving.delete(endpoint)
      this.#socket.disconnect(endpoint)
    }
  }

  close() {
    this.#socket.close()
  }

  async #hear() {
    for await (const [frame] of this.#socket) {
      try {
        if (frame[0] === PRIVATE[0]) this.#hearWelcome(frame)
        else this.#read(frame)
      } catch (error) {
        console.error(`${this.topic}: a message cannot be read: ${error.message}`)
      }
    }
  }

  #hearWelcome(frame) {
    if (!beginsWith(frame, this.private)) return
    const rest = frame.subarray(this.private.length)
    const end = rest.indexOf(0)
    this.welcomed.add(rest.toString('utf8', 0, end))
    if (end + 1 < rest.length) this.#read(rest.subarray(end + 1)) // a notice
  }

  #read(frame) {
    const text = frame.toString()
    const [, head, ...payloads] = text.split('\0') // one message or more; none in a mere notice
    const [node, number, , encoding, run = '', sent] = JSON.parse(head)
    const isJson = encoding === 'json'
    const key = `${node}\0${run}` // each start of a program counts from 1
    const messages = isJson ? payloads.length : 1
    if (sent === undefined) this.#count(key, number, messages)
    else if (!this.#isNews(key, number, sent, messages)) return
    if (isJson) for (const payload of payloads) this.callback(JSON.parse(payload))
  }

  // Sees what is missing before these messages.
  #count(key, number, messages) {
    const { first, last } = this.#numbers.get(key) ?? { first: number, last: number - 1 }
    this.lost += Math.max(0, number - last - 1)
    this.#numbers.set(key, { first, last: number + messages - 1 })
  }

  // Hears how many messages there were by now; whether the latched one beside it is new to us.
  #isNews(key, number, sent, messages) {
    const { first, last } = this.#numbers.get(key) ?? { first: sent + 1, last: sent }
    const wasLost = messages > 0 && number > last
    const isNew = messages > 0 && (wasLost || number < first)
    this.lost += Math.max(0, sent - last - (wasLost ? 1 : 0))
    const lowest = isNew ? Math.min(first, number) : first
    this.#numbers.set(key, { first: lowest, last: Math.max(last, sent) })
    return isNew
  }
}

export class Node {
  instance = randomUUID()
  #answer = { version: 0 }
  #epoch = ''
  #places
  #dealer = new Dealer({ immediate: true, sendTimeout: 0, linger: 200, reconnectMaxInterval: 500 })
  #outbox = new XPublisher({
    sendHighWaterMark: HIGH_WATER_MARK,
    linger: 500, // the last words are still sent
    verbosity: 'allSubs' // also those that a broker brings that was started again
  })
  #publishers = new Map()
  #send = inOrder(this.#outbox)
  #lostTold = 0
  #nextAliveMs = performance.now() + ALIVE_MS
  #stop = new AbortController()
  #subscriptions = []
  #version = 0
  #versionSent = 0

  constructor(name, type, settings = {}) {
    Object.assign(this, { name, type, settings })
  }

  // Joins; throws NepError when there is no master, or when the name is taken.
  async join() {
    this.#places = places()
    if (this.#places.toPublish) this.#outbox.connect(this.#places.toPublish)
    else await this.#outbox.bind('tcp://127.0.0.1:*')
    this.#dealer.connect(this.#places.master)
    this.ended = [this.#hearMaster(), this.#hearSubscribers()]
    this.beating = setInterval(() => this.#beat(), HEARTBEAT_MS)
    this.states = await this.publisher('/node_state', { latched: true })
    this.state('starting')
    return this
  }

  get isStopping() {
    return this.#stop.signal.aborted
  }

  stop() {
    this.#stop.abort()
  }

  // A setting that is a number: the launcher gives all settings of the manifest.
  number(name) {
    const number = Number(this.settings[name])
    if (Number.isFinite(number)) return number
    throw new NepError(`The setting ${name} is no number: ${this.settings[name] ?? 'missing'}.`, [
      `Write a number, such as ${name}=0.5.`
    ])
  }

  // The publisher of a topic; the subscribers that the master knows miss no message of it.
  async publisher(topic, { latched = false } = {}) {
    const run = this.instance.slice(0, 8)
    const publisher = new Publisher(this.name, run, topic, latched, this.#send)
    this.#publishers.set(topic, publisher)
    const known = (await this.#tellMaster()).subscribers[topic] ?? []
    await this.#until(1, () => known.every((id) => publisher.seen.has(id)))
    return publisher
  }

  // Lets `callback` have every message of a topic.
  async subscribe(topic, callback) {
    const added = new Subscription(topic, callback, this.#places.toHear)
    this.#subscriptions.push(added)
    const known = (await this.#tellMaster()).publishers[topic] ?? []
    await this.#until(1, () => known.every(({ instance }) => added.welcomed.has(instance)))
  }

  ready(description = '') {
    return this.state('ready', description)
  }

  warn(description) {
    return this.state('warning', description)
  }

  // Tells everybody how the node is doing: 'ready', 'running', 'busy', 'warning', ...
  state(event, description = '') {
    const { name, type } = this
    const time = Date.now() / 1000
    const told = { node: name, type, event, description, pid: process.pid, host: hostname(), time }
    // A heartbeat is not kept: who comes later wants to know that the node is ready.
    return this.states.send(told, { latch: event !== 'alive' })
  }

  // Waits so many seconds; true, and at once, when the node is asked to stop.
  async wait(seconds) {
    await sleep(seconds * 1000, null, { signal: this.#stop.signal }).catch(() => {})
    return this.isStopping
  }

  // Says how it ended, and leaves.
  async close(event = 'stopped', description = '') {
    clearInterval(this.beating)
    if (this.states) {
      await this.state(event, description)
      await this.#say({ do: 'bye', instance: this.instance })
    }
    for (const socket of [this.#dealer, this.#outbox, ...this.#subscriptions]) socket.close()
  }

  async #until(seconds, isDone) {
    const endMs = performance.now() + seconds * 1000
    while (!isDone() && !this.isStopping && performance.now() < endMs) await sleep(5)
  }

  // Tells the master all that this node has, and waits for the answer.
  async #tellMaster() {
    const version = ++this.#version
    const isAnswered = () => this.#answer.version >= version
    await this.#until(5, () => {
      if (this.#versionSent < version) this.#register()
      return isAnswered()
    })
    if (!isAnswered()) {
      throw new NepError(`No NEP master answers at ${this.#places.master}.`, [
        'Open NEP Studio, or type: nep master',
        'Is NEP_MASTER the address of the master?'
      ])
    }
    if (this.#answer.do === 'refused') {
      throw new NepError(this.#answer.sentence, this.#answer.checklist)
    }
    return this.#answer
  }

  async #register() {
    const version = this.#version
    const registration = {
      instance: this.instance,
      node: this.name,
      pid: process.pid,
      host: hostname(),
      endpoint: this.#places.toPublish || this.#outbox.lastEndpoint,
      publishes: [...this.#publishers.keys()],
      subscribes: Object.fromEntries(this.#subscriptions.map(({ id, topic }) => [id, topic]))
    }
    const request = { do: 'register', version, epoch: this.#epoch, registration }
    this.#versionSent = version
    if (!(await this.#say(request))) this.#versionSent = 0 // the master is away: try again
  }

  // False when the master is away.
  async #say(request) {
    try {
      await this.#dealer.send(JSON.stringify(request))
      return true
    } catch (error) {
      if (error.code === 'EAGAIN' || error.code === 'EBUSY') return false
      throw error
    }
  }

  async #hearMaster() {
    for await (const [frame] of this.#dealer) {
      const said = JSON.parse(frame)
      if (said.do === 'registered' || said.do === 'refused') this.#answer = said
      if (said.do === 'error') this.#answer = { ...said, do: 'refused', version: this.#version }
      if (said.do === 'registered') {
        this.#epoch = said.epoch
        for (const [topic, who] of Object.entries(said.publishers)) this.#connect(topic, who)
      }
      if (said.do === 'publishers') this.#connect(said.topic, said.publishers)
      const isNew = said.do === 'heard' && (!said.known || said.epoch !== this.#epoch)
      if (isNew) this.#register() // another master: it wants to know everything
      if (said.do === 'stop_asked') {
        process.exitCode = 71 // the launcher knows by it that it is not to start us again
        this.stop()
      }
    }
  }

  #connect(topic, publishers) {
    for (const one of this.#subscriptions) if (one.topic === topic) one.connect(publishers)
  }

  // Welcomes who comes: a private subscription follows that of the data on the same connection,
  // so when we see the private one, the subscriber gets all that we send from now on.
  async #hearSubscribers() {
    for await (const [event] of this.#outbox) {
      const wanted = event.subarray(1)
      if (!beginsWith(wanted, PRIVATE)) continue
      const [topic, id, end] = wanted.toString('utf8', PRIVATE.length).split('\0')
      if (end !== '') continue
      const publisher = this.#publishers.get(topic)
      const answer = Buffer.from(`${this.instance}\0${publisher?.notice() ?? ''}`)
      if (event[0] === 1) this.#send(Buffer.concat([wanted, answer]))
      if (event[0] === 1) publisher?.seen.add(id)
      else publisher?.seen.delete(id)
    }
  }

  #beat() {
    if (this.#epoch) this.#say({ do: 'alive', instance: this.instance })
    else this.#versionSent = 0 // no answer yet: ask once more
    for (const one of this.#subscriptions) one.tend()
    if (!this.states || performance.now() < this.#nextAliveMs) return
    this.#nextAliveMs = performance.now() + ALIVE_MS
    this.state('alive')
    const lost = this.#subscriptions.reduce((sum, one) => sum + one.lost, 0)
    if (lost > this.#lostTold) this.warn(`Messages were lost: ${lost - this.#lostTold}.`)
    this.#lostTold = lost
  }
}

// Runs a node to its end. The launcher says how it is called and what is set:
// --name NAME setting=value ...
/** Tells the launcher, if there is one, why the node cannot go on: a person sees it. */
function handOver(error) {
  const place = process.env.NEP_FAULT_FILE
  if (!place || !(error instanceof NepError)) return
  const fault = { code: 'refused', sentence: error.message, checklist: error.checklist }
  try {
    writeFileSync(place, JSON.stringify(fault), { flag: 'wx' })
  } catch { /* the launcher then has the last line that was written */ }
}

export async function run(usualName, type, work) {
  const words = process.argv.slice(2)
  const at = words.indexOf('--name')
  const name = at >= 0 ? words[at + 1] : usualName
  const settings = Object.fromEntries(
    words.filter((word) => /^\w+=/.test(word)).map((word) => word.split(/=(.*)/s).slice(0, 2))
  )
  const node = new Node(name, type, settings)
  for (const signal of ['SIGTERM', 'SIGINT', 'SIGBREAK']) process.on(signal, () => node.stop())
  try {
    await node.join()
    await work(node)
    await node.close()
  } catch (error) {
    await node.close('crashed', error.message)
    handOver(error)
    console.error(error instanceof NepError ? error.message : error)
    for (const step of error.checklist ?? []) console.error(`  [ ] ${step}`)
    process.exitCode = 1
  }
}
