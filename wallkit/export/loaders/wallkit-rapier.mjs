// Written by `wallkit export`; the same for every level. Adds a level of `--format rapier` to a world of Rapier:
//   addLevel(RAPIER, world, level)                 returns the colliders, one a wall
// Polylines stop from both sides. Rapier takes the average of two restitutions unless one of the two asks for another
// rule: here the larger counts, so leave the ball's at 0.
export function addLevel(RAPIER, world, level) {
  const body = world.createRigidBody(RAPIER.RigidBodyDesc.fixed());
  return level.walls.map((wall) => {
    const points = wall.closed ? [...wall.points, wall.points[0]] : wall.points;
    const description = RAPIER.ColliderDesc.polyline(new Float32Array(points.flatMap((point) => [point.x, point.y])))
      .setRestitution(wall.restitution)
      .setRestitutionCombineRule(RAPIER.CoefficientCombineRule.Max)
      .setFriction(0)
      .setFrictionCombineRule(RAPIER.CoefficientCombineRule.Min);
    return world.createCollider(description, body);
  });
}
