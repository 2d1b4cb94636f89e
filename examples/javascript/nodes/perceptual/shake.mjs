// A perceptual node: hears an inertial sensor, and tells when it is shaken.
//
// A rule of a block program waits for it: "when human state is shaken".
import { run } from '../../nep.mjs'

const GRAVITY_M_S2 = 9.81
const CALM_S = 1 // so long it must be calm before it can be shaken again

await run('shake', 'perceptual', async (node) => {
  const strength = node.number('strength_m_s2')
  const behavior = await node.publisher('/human_behavior')
  let level = 0 // how much the acceleration differs from gravity, smoothed
  let lastS = -Infinity
  await node.subscribe('/imu', (imu) => {
    imu.acc.forEach((row, i) => {
      const excess = Math.abs(Math.hypot(...row) - GRAVITY_M_S2) // the same however it is held
      level += (excess - level) * Math.min(1, 4 / imu.rate_hz)
      if (level < strength) return
      const begins = imu.t[i] - lastS > CALM_S || imu.t[i] < lastS // another sensor's clock
      lastS = imu.t[i]
      if (!begins) return
      behavior.send({
        human_state: 'shaken',
        certainty: Math.min(1, (0.5 * level) / strength), // 0.5: just enough; 1: twice as much
        source: imu.source,
        time: Date.now() / 1000
      })
    })
  })
  node.ready('tells when a sensor is shaken')
  while (!(await node.wait(1))) continue
})
