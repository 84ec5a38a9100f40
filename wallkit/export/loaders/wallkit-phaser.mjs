// Written by `wallkit export`; the same for every level. Adds a level of `--format phaser` to a scene of Phaser:
//   preload() { this.load.json("level", "level.phaser.json") }
//   create()  { addLevel(this, this.cache.json.get("level")) }
// Phaser puts the centre of mass where it is told to, and matter forgets the restitution of static bodies: the first
// is in the file, the second is set here, after creation. Of a pair the larger counts: leave the ball's at 0.
export function addLevel(scene, level) {
  const { origin, walls } = JSON.parse(JSON.stringify(level)); // Phaser sorts the vertices that it is given in place
  const body = scene.matter.add.fromPhysicsEditor(origin.x, origin.y, walls);
  setMaterial(body, walls);
  return body;
}

export function setMaterial(body, walls) {
  const restitution = walls.fixtures.flatMap((fixture) => fixture.vertices.map(() => fixture.restitution));
  const parts = body.parts.length > 1 ? body.parts.slice(1) : body.parts; // the first of several is the whole
  parts.forEach((part, index) => Object.assign(part, { restitution: restitution[index], friction: 0, frictionStatic: 0 }));
}
