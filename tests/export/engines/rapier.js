// Six balls in each level, added by the loader for Rapier.
const fs = require("fs");
const { pathToFileURL } = require("url");
const RAPIER = require("@dimforge/rapier2d-compat");

const { loader, games } = JSON.parse(process.argv[2]);

async function main() {
  const said = console.warn;
  console.warn = () => {}; // a word of its initialiser about its own parameters
  await RAPIER.init();
  console.warn = said;
  const { addLevel } = await import(pathToFileURL(loader));
  const results = games.map((game) => {
    const world = new RAPIER.World({ x: 0, y: 0 });
    const colliders = addLevel(RAPIER, world, JSON.parse(fs.readFileSync(game.file, "utf8")));
    const balls = game.velocities.map(([vx, vy]) => {
      const body = RAPIER.RigidBodyDesc.dynamic().setTranslation(game.x, game.y).setLinvel(vx, vy).setCcdEnabled(true);
      const ball = world.createRigidBody(body);
      const groups = 0x00020001; // member of 1, meets 0
      world.createCollider(
        RAPIER.ColliderDesc.ball(game.radius).setFriction(0).setRestitution(0).setCollisionGroups(groups),
        ball,
      );
      return ball;
    });
    colliders.forEach((collider) => collider.setCollisionGroups(0x0001ffff));
    for (let step = 0; step < game.seconds * 60; step++) world.step();
    const places = balls.map((ball) => [ball.translation().x, ball.translation().y]);
    const segments = colliders.map((collider) => collider.vertices().length / 2 - 1);
    const restitution = colliders.map((collider) => collider.restitution());
    const speeds = balls.map((ball) => Math.hypot(ball.linvel().x, ball.linvel().y));
    world.free();
    return { places, segments, restitution, speeds };
  });
  console.log(JSON.stringify(results));
}

main();
