// A sensory node: an inertial sensor on a board, which somebody shakes now and then.
//
// The sensor is made up, so that nothing need be bought. Put the driver of yours in its place:
// whatever publishes /imu is drawn, recorded and understood by all that hears a watch.
import { run } from '../../nep.mjs'

const GRAVITY_M_S2 = 9.81
const BATCH_S = 0.02
const TURN_S = 0.125 // one shake there and back

// A sensor at rest feels what holds it up.
function accelerationMS2(tS, everyS) {
  const isShaken = everyS > 0 && tS % everyS > everyS - 1
  return [isShaken ? 25 * Math.sin((2 * Math.PI * tS) / TURN_S) : 0, 0, GRAVITY_M_S2]
}

await run('board', 'sensory', async (node) => {
  const rateHz = node.number('rate_hz')
  const everyS = node.number('shaken_every_s')
  const imu = await node.publisher('/imu')
  node.ready(`an inertial sensor with ${rateHz} samples a second`)
  const startMs = performance.now()
  let sent = 0
  while (!(await node.wait(BATCH_S))) {
    const t = []
    const nowS = (performance.now() - startMs) / 1000
    for (; sent / rateHz < nowS; sent++) t.push(sent / rateHz) // measured since the last time
    if (!t.length) continue
    imu.send({
      source: 'board',
      rate_hz: rateHz,
      t,
      acc: t.map((tS) => accelerationMS2(tS, everyS)),
      gyr: t.map(() => [0, 0, 0]),
      simulated: true
    })
  }
})
