// Written by `wallkit export`; the same for every level. Adds a level of `--format matter` to a world of matter.js:
//   addLevel(Matter, engine.world, level)          returns the bodies, one a convex piece
// matter sets the restitution of a static body to 0 and its friction to 1 when it makes it, whatever it was asked
// for, so both are set afterwards. Of a pair the larger restitution counts: leave the ball's at 0. A ball bounces
// only when it moves by more than 2 px a step.
export function addLevel(Matter, world, level) {
  const bodies = [];
  for (const solid of level.solids) {
    for (const piece of solid.pieces) {
      const vertices = piece.points.map((point) => ({ x: point.x, y: point.y }));
      const body = Matter.Body.create({
        label: solid.name,
        isStatic: true,
        vertices,
        position: Matter.Vertices.centre(vertices),
      });
      body.restitution = solid.restitution;
      body.friction = 0;
      body.frictionStatic = 0;
      bodies.push(body);
    }
  }
  Matter.Composite.add(world, bodies);
  return bodies;
}
